#include "apps/kit/output/gnuplot.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace kit {
namespace {

[[noreturn]] void refuse(const char* call, int error) {
  tess::fail(tess::ErrorCode::environment, "gnuplot: ", call, " failed (",
             std::generic_category().message(error), ")");
}

/// A file without a name, gone when closed.
class Temporary {
 public:
  Temporary() : file_(std::tmpfile(), &std::fclose) {
    if (file_ == nullptr) refuse("tmpfile", errno);
  }
  [[nodiscard]] int descriptor() const { return ::fileno(file_.get()); }

  void write(const std::string& content) {
    if (std::fwrite(content.data(), 1, content.size(), file_.get()) != content.size() ||
        std::fflush(file_.get()) != 0)
      refuse("write to a temporary file", errno);
    std::rewind(file_.get());
  }
  [[nodiscard]] std::string read() {
    std::string content;
    char block[65536];
    std::rewind(file_.get());
    while (const std::size_t n = std::fread(block, 1, sizeof block, file_.get()))
      content.append(block, n);
    return content;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

/// The lines of gnuplot's complaint that say something, as one.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  const auto twice = [](char a, char b) { return a == ' ' && b == ' '; };
  text.erase(std::unique(text.begin(), text.end(), twice), text.end());
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text.substr(0, 300);
}

/// gnuplot escapes & and <, but not >, which XML does not allow behind ]]. It writes no CDATA.
void escape_ends(std::string& svg) {
  for (std::size_t at = 0; (at = svg.find("]]>", at)) != std::string::npos;)
    svg.replace(at, 3, "]]&gt;");
}

}  // namespace

Drawing draw_with_gnuplot(const std::string& script) {
  Temporary in, out, complaint;
  in.write(script);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, in.descriptor(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, out.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, complaint.descriptor(), STDERR_FILENO);
  char name[] = "gnuplot", defaults[] = "-d", standard_input[] = "-";
  char* const arguments[] = {name, defaults, standard_input, nullptr};
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, name, &files, nullptr, arguments, ::environ);
  posix_spawn_file_actions_destroy(&files);
  if (error == ENOENT) return {.missing = true};
  if (error != 0) refuse("posix_spawnp", error);

  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) refuse("waitpid", errno);
  Drawing drawing{.svg = out.read()};
  escape_ends(drawing.svg);
  const bool whole = drawing.svg.find("</svg>") != std::string::npos;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || !whole) {
    drawing.error = one_line(complaint.read());
    if (drawing.error.empty()) drawing.error = tess::text("it ended with status ", status);
  }
  return drawing;
}

}  // namespace kit
