#include "apps/kit/progress.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <fcntl.h>
#include <poll.h>
#include <thread>
#include <unistd.h>

using kit::Progress;
using namespace std::chrono_literals;

namespace {

/// A pseudo-terminal. The test reads what is written to it.
class Terminal {
 public:
  Terminal() : reader_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    REQUIRE(reader_ >= 0);
    REQUIRE(::grantpt(reader_) == 0);
    REQUIRE(::unlockpt(reader_) == 0);
    writer_ = std::fopen(::ptsname(reader_), "w");
    REQUIRE(writer_ != nullptr);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  ~Terminal() {
    std::fclose(writer_);
    ::close(reader_);
  }
  [[nodiscard]] std::FILE* file() const { return writer_; }

  /// Reads until `text` appears; false if it does not within ten seconds.
  bool shows(const std::string& text) {
    while (seen_.find(text) == std::string::npos) {
      pollfd ready{reader_, POLLIN, 0};
      char bytes[256];
      if (::poll(&ready, 1, 10000) <= 0) return false;
      const ssize_t n = ::read(reader_, bytes, sizeof bytes);
      if (n <= 0) return false;
      seen_.append(bytes, static_cast<std::size_t>(n));
    }
    seen_.erase(0, seen_.find(text) + text.size());
    return true;
  }
  [[nodiscard]] bool silent() const {
    pollfd ready{reader_, POLLIN, 0};
    return ::poll(&ready, 1, 0) == 0;
  }

 private:
  int reader_;
  std::FILE* writer_ = nullptr;
  std::string seen_;
};

}  // namespace

TEST_CASE("progress names the phase on a terminal and removes its line", "[apps][progress]") {
  Terminal terminal;
  {
    Progress progress(terminal.file(), 1ms, 1ms);
    progress.phase("narrow");
    progress.part(3, 8);
    CHECK(terminal.shows("\r\x1b[K3 of 8: narrow, 0 s"));
    progress.phase("report");
    CHECK(terminal.shows("report"));
  }
  CHECK(terminal.shows("\r\x1b[K"));
}

TEST_CASE("the time left is that of the parts to come", "[apps][progress]") {
  CHECK_FALSE(kit::seconds_left(0, 0, 0, 5).has_value());
  CHECK_FALSE(kit::seconds_left(1, 4, 0, 5).has_value());
  // Three parts took 6 s: this one has 1.5 s to go, and two of 2 s come after it.
  CHECK(kit::seconds_left(4, 6, 6, 0.5) == 5.5);
  CHECK(kit::seconds_left(4, 6, 6, 3) == 4.0);
  CHECK(kit::seconds_left(6, 6, 10, 9) == 0.0);
}

TEST_CASE("progress says how long the rest takes", "[apps][progress]") {
  Terminal terminal;
  Progress progress(terminal.file(), 1ms, 1ms);
  progress.phase("search");
  progress.part(1, 3);
  CHECK(terminal.shows("1 of 3: search, 0 s"));
  progress.part(2, 3);
  CHECK(terminal.shows("2 of 3: search, 0 s, about 0 s left"));
}

TEST_CASE("short work shows no progress", "[apps][progress]") {
  const Terminal terminal;
  {
    Progress progress(terminal.file(), 1h);
    progress.phase("narrow");
    progress.clear();
  }
  CHECK(terminal.silent());
}

TEST_CASE("progress writes nothing to a file", "[apps][progress]") {
  const tess::test::Scratch scratch;
  const std::string path = scratch.path("log");
  std::FILE* file = std::fopen(path.c_str(), "w");
  {
    Progress progress(file, 0ms, 1ms);
    std::this_thread::sleep_for(20ms);
  }
  std::fclose(file);
  CHECK(tess::test::slurp(path).empty());
}
