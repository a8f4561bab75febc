// The page of a run that serves one (--monitor PORT), as a table in a terminal: connects, and
// prints a frame whenever one comes.
//
//     tess_monitor --connect localhost:8080 [--token T] [--frames N] [--heat Block [--by pe]]
//     tess_monitor --connect [::1]:8080
#include "runtime/command_line.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>

#include <algorithm>
#include <cstdio>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <unistd.h>
#include <vector>

namespace {

using nlohmann::json;
using Tcp = boost::asio::ip::tcp;

struct Options {
  std::string connect = "localhost:8080", token;
  std::string heat, by = "load";
  std::int32_t n_frames = 0;
  std::int32_t n_rows = 24;
};

/// A stream of events of a run. Throws tess::Error if it cannot be had.
class Events {
 public:
  Events(const Options& options, const std::string& path) : options_(options), socket_(io_) {
    std::string host = options.connect, port = "8080";
    if (const std::size_t colon = host.rfind(':');
        colon != std::string::npos && !host.ends_with(']')) {
      port = host.substr(colon + 1);
      if (tess::parse_number<std::uint16_t>(port).value_or(0) == 0)
        tess::fail(tess::ErrorCode::bad_argument, "--connect ", host, ": ", port,
                   " is no port; give HOST:PORT with one of 1 … 65535");
      host.resize(colon);
    }
    const bool six = host.starts_with('[') && host.ends_with(']');  // IPv6: [::1]
    boost::system::error_code error;
    const auto found =
        Tcp::resolver(io_).resolve(six ? host.substr(1, host.size() - 2) : host, port, error);
    if (!error) boost::asio::connect(socket_, found, error);
    if (error) refuse(error.message() + "; is the run started with --monitor?");
    const std::string token = options.token.empty() ? "" : "&token=" + options.token;
    boost::asio::write(socket_, boost::asio::buffer("GET " + path + token +
                                                    " HTTP/1.1\r\nHost: " + host + "\r\n\r\n"));
    const std::string status = line();
    if (status.find(" 200 ") == std::string::npos)
      refuse("it answers \"" + status + "\"; a run with --monitor-token wants --token");
    while (!line().empty()) {
    }
  }

  /// True if something has come that next() has not read.
  [[nodiscard]] bool has_more() {
    boost::system::error_code error;
    return !over_ && (!text_.empty() || socket_.available(error) != 0);
  }
  /// Reads the next event; false if the run is over.
  bool next(std::string& kind, json& data) {
    for (kind.clear();;) {
      const std::string text = line();
      if (over_) return false;
      if (text.starts_with("event: ")) kind = text.substr(7);
      if (text.starts_with("data: ")) data = json::parse(text.substr(6));
      if (text.empty() && !kind.empty()) return true;
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    tess::fail(tess::ErrorCode::environment, "--connect ", options_.connect, ": ", why);
  }
  std::string line() {
    boost::system::error_code error;
    const std::size_t n =
        boost::asio::read_until(socket_, boost::asio::dynamic_buffer(text_), '\n', error);
    over_ = static_cast<bool>(error);
    std::string out = text_.substr(0, n);
    text_.erase(0, n);
    while (!out.empty() && (out.back() == '\n' || out.back() == '\r')) out.pop_back();
    return out;
  }

  const Options& options_;
  boost::asio::io_context io_;
  Tcp::socket socket_;
  std::string text_;
  bool over_ = false;
};

void print_frame(const json& frame, const std::vector<std::string>& lines, std::int32_t n_rows) {
  const auto n_pes = frame["busy"].size();
  fmt::print("{:.1f} s", frame["t"].get<double>());
  if (frame.contains("virtual")) fmt::print(" (virtual {:.6g} s)", frame["virtual"].get<double>());
  const auto some = [](std::uint64_t n, const char* one, const char* more) {
    return fmt::format("{} {}", n, n == 1 ? one : more);
  };
  fmt::print(", {} in {}, {} open, {}\n", some(n_pes, "PE", "PEs"),
             some(frame["processes"], "process", "processes"),
             some(frame["epochs"], "epoch", "epochs"),
             some(frame["migrations"], "migration", "migrations"));
  // With more PEs than rows a row is the mean of several.
  const std::size_t rows = std::min(n_pes, static_cast<std::size_t>(n_rows));
  fmt::print("{:>13} {:>6} {:>12} {:>9}\n", "PEs", "busy", "messages/s", "queue");
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t from = row * n_pes / rows, to = (row + 1) * n_pes / rows;
    double busy = 0, rate = 0, queue = 0;
    for (std::size_t pe = from; pe < to; ++pe) {
      busy += frame["busy"][pe].get<double>() / static_cast<double>(to - from);
      rate += frame["rate"][pe].get<double>();
      queue += frame["queue"][pe].get<double>();
    }
    fmt::print("{:>13} {:>5.0f}% {:>12.0f} {:>9.0f} {}\n",
               to - from == 1 ? fmt::format("{}", from) : fmt::format("{}-{}", from, to - 1), busy,
               rate, queue, std::string(static_cast<std::size_t>(busy / 4), '#'));
  }
  fmt::print("{}\n", frame["limits"].get<std::string>());
  for (const json& late : frame["late"])
    fmt::print("PE {} is in {}\n", late[0].get<int>(), late[1].get<std::string>());
  fmt::print("{:>24} {:>10} {:>10} {:>10}\n", "chares", "all", "least", "most");
  for (const json& one : frame["collections"])
    fmt::print("{:>24} {:>10} {:>10} {:>10}\n", one["name"].get<std::string>(),
               one["n"].get<std::uint64_t>(), one["least"].get<std::uint64_t>(),
               one["most"].get<std::uint64_t>());
  for (const std::string& line : lines)
    if (!line.empty()) fmt::print("{}\n", line);
  fmt::print("\n");
  std::fflush(stdout);
}

/// The heat map of an array, as the line that sums it up.
class Heat {
 public:
  explicit Heat(const Options& options) : options_(options) {}

  /// Asks for it once a frame names the array, and reads what has come.
  void follow(const json& frame) {
    if (options_.heat.empty()) return;
    for (const json& one : frame["collections"]) {
      if (events_ || one["name"].get<std::string>().find(options_.heat) == std::string::npos)
        continue;
      line_ = options_.heat + ": the PEs are asked";
      events_.emplace(options_,
                      "/heat?by=" + options_.by + "&array=" + one["id"].get<std::string>());
    }
    if (!events_) line_ = "no array is named " + options_.heat + " yet";
    std::string kind;
    json data;
    while (events_ && events_->has_more() && events_->next(kind, data))
      line_ = data["name"].get<std::string>() + " by " + options_.by + ": " +
              data["summary"].get<std::string>();
  }
  [[nodiscard]] const std::string& line() const { return line_; }

 private:
  const Options& options_;
  std::optional<Events> events_;
  std::string line_;
};

int watch(const Options& options) {
  Events events(options, "/events?");
  Heat heat(options);
  bool is_past = true;
  const bool clears = isatty(STDOUT_FILENO) != 0;
  std::string kind, round;
  json data;
  for (std::int32_t n = 0; options.n_frames == 0 || n < options.n_frames;) {
    if (!events.next(kind, data)) {
      fmt::print("the run is over\n");
      return 0;
    }
    if (kind == "round") round = data["text"];
    is_past = is_past && kind != "now";  // a browser gets the frames of minutes first
    if (is_past || kind != "frame") continue;
    if (clears) fmt::print("\033[H\033[2J");
    heat.follow(data);
    print_frame(data, {round, heat.line()}, options.n_rows);
    ++n;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] {
    Options options;
    tess::CommandLine line(
        "Shows a run that was started with --monitor PORT, as a table in a terminal.");
    line.option("--connect HOST:PORT", options.connect, "HOST:PORT of the run");
    line.option("--token T", options.token, "its --monitor-token");
    line.option("--heat ARRAY", options.heat,
                "sums up the heat map of the array with this in its name");
    line.option("--by", options.by, "what the heat map shows: load, or the PE that holds most")
        .one_of({"load", "pe"});
    line.option("--frames", options.n_frames,
                "ends after so many frames from now on; 0: when the run ends")
        .between(0, 1'000'000'000);
    line.option("--rows", options.n_rows, "lines for PEs; more PEs share them").between(1, 10'000);
    if (!line.parse(argc, argv, "")) return 0;
    if (options.heat.empty()) line.refuse_without("a --heat map", {"--by"});
    return watch(options);
  });
}
