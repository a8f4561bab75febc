// The live view of real runs, as a browser sees it.
#include "runtime/more/monitor.hpp"

#include "runtime/balance.hpp"
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>

#include <atomic>
#include <future>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

using namespace std::chrono_literals;
using nlohmann::json;
using Tcp = boost::asio::ip::tcp;

namespace {

/// Asks the server for something and reads until it ends or `enough`.
class Browser {
 public:
  Browser(unsigned short port, const std::string& target, const std::string& host = "localhost")
      : socket_(io_) {
    socket_.connect(Tcp::endpoint(boost::asio::ip::address_v4::loopback(), port));
    boost::asio::write(
        socket_, boost::asio::buffer("GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n"));
  }
  /// The whole answer.
  std::string read() {
    boost::system::error_code error;
    while (!error) read_more(error);
    return text_;
  }
  void wait_for_headers() {
    boost::system::error_code error;
    while (!error && text_.find("\r\n\r\n") == std::string::npos) read_more(error);
  }
  /// True if it gets events, false if the server refuses.
  bool listens() {
    wait_for_headers();
    return text_.starts_with("HTTP/1.1 200");
  }
  /// The data of the next event of this kind.
  json next(const std::string& kind) {
    const std::string head = "event: " + kind + "\ndata: ";
    while (true) {
      const std::size_t at = text_.find(head, seen_);
      const std::size_t end = at == std::string::npos ? at : text_.find("\n\n", at);
      if (end != std::string::npos) {
        seen_ = end;
        return json::parse(text_.substr(at + head.size(), end - at - head.size()));
      }
      boost::system::error_code error;
      read_more(error);
      if (error) throw std::runtime_error("the events ended before a " + kind);
    }
  }

 private:
  void read_more(boost::system::error_code& error) {
    std::array<char, 4096> some{};
    text_.append(some.data(), socket_.read_some(boost::asio::buffer(some), error));
  }

  boost::asio::io_context io_;
  Tcp::socket socket_;
  std::string text_;
  std::size_t seen_ = 0;
};

struct Word {
  int key = 0;
};

class Watched : public tess::Chare<Watched, tess::Index1> {
 public:
  tess::Task wait_for_a_word() { co_await words_.take(5); }
  void hear(Word word) { words_.put(word); }
  void draw() {
    if (index().x == 3 && n_shown++ % 50 != 0) return;  // rarely
    tess::show("numbers", [this] {
      ++n_drawn;
      return tess::Picture{4, 1, index().x, 0, 1, {static_cast<double>(index().x)}};
    });
  }
  static inline std::atomic<int> n_shown = 0, n_drawn = 0;  // by the last one; parts of all
  void sync() { at_sync(); }
  void resume_from_sync() { ++n_resumed_; }

  void serialize(auto& ar) { ar(words_, n_resumed_); }

 private:
  tess::Mailbox<&Word::key> words_;
  int n_resumed_ = 0;
};

class Busy : public tess::Chare<Busy, tess::Index1> {
 public:
  void stay() {
    inside = true;
    inside.notify_all();
    leave.wait(false);
  }
  static inline std::atomic<bool> inside = false, leave = false;
};

/// Receives the lines of a run, of which one names the port.
std::function<void(const std::string&)> port_of(std::promise<unsigned short>& port) {
  return [&port](const std::string& line) {
    const std::string begin = "http://127.0.0.1:";
    if (const std::size_t at = line.find(begin); at != std::string::npos)
      port.set_value(static_cast<unsigned short>(std::stoi(line.substr(at + begin.size()))));
  };
}

/// Runs a program until `watch(port)`, which runs on a thread of its own, is done.
int watched_run(std::unique_ptr<tess::Machine> machine, const std::string& token,
                const std::function<void(unsigned short)>& watch) {
  tess::Setup setup;
  const bool simulated = machine->virtual_time();
  setup.machine = std::move(machine);
  setup.options.monitor = tess::MonitorOptions{"127.0.0.1", 0, token, 20};
  std::promise<unsigned short> port;
  setup.options.report = port_of(port);
  std::atomic<bool> done = false;
  std::thread browser([&] {
    watch(port.get_future().get());
    done = true;
  });
  const int code = tess::run(setup, [&]() -> tess::Task {
    const auto all = tess::create<Watched>(tess::range(4));
    tess::BalanceOptions options;
    options.strategy = "greedy";
    tess::start_balancing(all, options);
    all[{2}].send<&Watched::wait_for_a_word>();
    all.broadcast<&Watched::sync>();
    while (!done) {
      all.broadcast<&Watched::draw>();
      if (simulated) std::this_thread::sleep_for(1ms);
      co_await tess::sleep(1ms);
    }
    all[{2}].send<&Watched::hear>(Word{5});
  });
  browser.join();
  return code;
}

std::unique_ptr<tess::Machine> machine_of(bool threads) {
  if (threads) return tess::make_threads_machine(2);
  tess::SimulatedOptions options;
  options.n_pes = 2;
  options.cost = 100ns;
  return tess::make_simulated_machine(options);
}

}  // namespace

TEST_CASE("a browser sees the run while it goes on", "[runtime][monitor]") {
  for (const bool threads : {false, true}) {
    CHECK(watched_run(machine_of(threads), "", [&](unsigned short port) {
            CHECK(Browser(port, "/").read().find("<title>Tessera") != std::string::npos);
            CHECK(Browser(port, "/etc/passwd").read().starts_with("HTTP/1.1 404"));
            CHECK(Browser(port, "/", "evil.example").read().starts_with("HTTP/1.1 403"));
            CHECK(Browser(port, "/", "127.evil.example").read().starts_with("HTTP/1.1 403"));
            CHECK(Browser(port, "/", "[::1]:80").read().starts_with("HTTP/1.1 200"));
            CHECK(Browser(port, "/", "127.0.0.1:80").read().starts_with("HTTP/1.1 200"));
            Browser events(port, "/events");
            CHECK(events.next("run")["program"] == "test_monitor");
            json frame;
            bool has_array = false;  // not before both PEs have answered
            while (!has_array) {
              frame = events.next("frame");
              for (const json& collection : frame["collections"])
                has_array = has_array || (collection["n"] == 4 &&
                                          collection["name"].get<std::string>().find("Watched") !=
                                              std::string::npos);
            }
            CHECK(frame["pes"] == 2);
            double part = 0;  // of an entry method that runs all the time
            do {
              frame = events.next("frame");
              for (const json& entry : frame["entries"])
                if (entry[0].get<std::string>().ends_with("Watched::draw")) part = entry[1];
            } while (part == 0);
            CHECK(part < 1);
            CHECK(frame.contains("virtual") == !threads);
            Browser pictures(port, "/events");
            json picture;
            do {
              picture = pictures.next("picture");
            } while (picture["values"] != "0055aaff");
            CHECK(picture["most"] == 3);
            Browser reports(port, "/events");
            CHECK(Browser(port, "/report").read().starts_with("HTTP/1.1 202"));
            CHECK(reports.next("report").get<std::string>().find("waits for a message of key 5") !=
                  std::string::npos);
            CHECK(Browser(port, "/events")
                      .next("round")["text"]
                      .get<std::string>()
                      .find("balance round 0") != std::string::npos);
          }) == 0);
  }
}

TEST_CASE("a picture is made only while a browser watches, with the parts that are shown rarely",
          "[runtime][monitor]") {
  for (const bool threads : {false, true}) {
    Watched::n_shown = Watched::n_drawn = 0;
    CHECK(watched_run(machine_of(threads), "", [&](unsigned short port) {
            while (Watched::n_shown < 200) std::this_thread::sleep_for(1ms);
            CHECK(Browser(port, "/").read().starts_with("HTTP/1.1 200"));
            CHECK(Watched::n_drawn == 0);
            Browser pictures(port, "/events");
            json picture;
            do {
              picture = pictures.next("picture");
            } while (picture["values"] != "0055aaff");
            CHECK(Watched::n_drawn >= 4);
          }) == 0);
  }
}

TEST_CASE("with a token, nothing is told without it", "[runtime][monitor]") {
  CHECK(
      watched_run(machine_of(true), "secret", [](unsigned short port) {
        for (const char* target : {"/", "/events", "/report", "/heat?array=1&by=pe",
                                   "/?token=", "/?token=secreT", "/?token=secret2"})
          CHECK(Browser(port, target).read().starts_with("HTTP/1.1 403"));
        CHECK(
            Browser(port, "/?x=1&token=secret", "any.example").read().starts_with("HTTP/1.1 200"));
      }) == 0);
}

TEST_CASE("a report names a PE that does not answer, and what it runs", "[runtime][monitor]") {
  tess::Setup setup;
  setup.machine = tess::make_threads_machine(2);
  setup.options.monitor = tess::MonitorOptions{"127.0.0.1", 0, "", 20};
  std::promise<unsigned short> port;
  setup.options.report = port_of(port);
  std::string reported;
  std::thread browser([&] {
    const unsigned short at = port.get_future().get();
    Busy::inside.wait(false);
    Browser reports(at, "/events");
    (void)reports.next("now");
    (void)Browser(at, "/report").read();
    reported = reports.next("report");
    Busy::leave = true;
    Busy::leave.notify_all();
  });
  const int code = tess::run(setup, [] {
    tess::create<Busy>(tess::range(2))[{1}].send<&Busy::stay>();  // on PE 1
  });
  browser.join();
  CHECK(code == 0);
  CHECK_THAT(reported, Catch::Contains("PE 1 has not answered within 300 ms") &&
                           Catch::Contains("Busy::stay"));
}

TEST_CASE("a heat map shows where elements are and what they cost, while it is watched",
          "[runtime][monitor]") {
  for (const bool threads : {false, true}) {
    INFO("threads " << threads);
    CHECK(watched_run(machine_of(threads), "", [&](unsigned short port) {
            Browser events(port, "/events");
            std::string id;
            while (id.empty()) {
              const json frame = events.next("frame");
              for (const json& one : frame["collections"])
                if (one["name"].get<std::string>().find("Watched") != std::string::npos)
                  id = one["id"];
            }
            Browser by_pe(port, "/heat?by=pe&array=" + id);
            json map;  // complete once all PEs have reported
            do {
              map = by_pe.next("heat");
            } while (!map["summary"].get<std::string>().starts_with("4 elements on "));
            CHECK(map["shape"] == json({4, 1, 1}));
            for (const json& pe : map["values"]) CHECK((pe == 0 || pe == 1));
            Browser by_load(port, "/heat?by=load&array=" + id);
            do {
              map = by_load.next("heat");
            } while (map["values"].get<std::string>().find("ff") == std::string::npos);
            CHECK(map["name"].get<std::string>().find("Watched") != std::string::npos);
            CHECK(Browser(port, "/heat?by=load").read().starts_with("HTTP/1.1 400"));
            CHECK(Browser(port, "/heat?array=" + id).read().starts_with("HTTP/1.1 400"));
            Browser third(port, "/heat?by=load&array=123"), fourth(port, "/heat?by=load&array=124");
            third.wait_for_headers();
            fourth.wait_for_headers();
            CHECK(Browser(port, "/heat?by=load&array=125").read().starts_with("HTTP/1.1 503"));
          }) == 0);
  }
}

TEST_CASE("browsers that do not read hold nothing up", "[runtime][monitor]") {
  CHECK(watched_run(machine_of(true), "", [](unsigned short port) {
          std::vector<std::unique_ptr<Browser>> silent;
          for (int i = 0; i < 8; ++i) silent.push_back(std::make_unique<Browser>(port, "/events"));
          Browser reader(port, "/events");
          for (int i = 0; i < 20; ++i) CHECK(reader.next("frame")["pes"] == 2);
        }) == 0);
}

TEST_CASE("64 browsers may listen at once, also if they ask at once", "[runtime][monitor]") {
  CHECK(watched_run(machine_of(true), "", [](unsigned short port) {
          std::vector<std::unique_ptr<Browser>> all;
          for (int i = 0; i < 70; ++i) all.push_back(std::make_unique<Browser>(port, "/events"));
          int n_listen = 0;
          for (const auto& one : all) n_listen += one->listens() ? 1 : 0;
          CHECK(n_listen == 64);
          all.clear();
          for (int i = 0; i < 100 && n_listen != 0; ++i) {  // there is room once they are gone
            std::this_thread::sleep_for(10ms);
            if (Browser(port, "/events").listens()) n_listen = 0;
          }
          CHECK(n_listen == 0);
        }) == 0);
}

TEST_CASE("a port that is taken is refused by name", "[runtime][monitor]") {
  boost::asio::io_context io;
  Tcp::acceptor taken(io, Tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0));
  taken.listen();
  tess::Setup setup;
  setup.machine = machine_of(false);
  setup.options.monitor = tess::MonitorOptions{"127.0.0.1", taken.local_endpoint().port(), "", 20};
  CHECK_THROWS_WITH(tess::run(setup, [] {}),
                    Catch::Contains(std::to_string(taken.local_endpoint().port())) &&
                        Catch::Contains("choose another port"));
  setup.options.monitor = tess::MonitorOptions{"0.0.0.0", 0, "", 20};
  CHECK_THROWS_WITH(tess::run(setup, [] {}), Catch::Contains("other machines can reach"));
}
