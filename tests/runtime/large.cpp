// Large messages between processes, run under mpirun; each process checks what it receives and ends
// the job if it is wrong.
//
//     test_large values          values of all sizes arrive intact; exit() in the middle of others
//     test_large memory          after warm-up a moved vector of 1 MiB takes no new pages
//     test_large flood           messages without credit stay with their sender
//     test_large produce         a producer that waits for room keeps little of its output
#include "runtime/more/room.hpp"
#include "runtime/runtime.hpp"

#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <sys/resource.h>
#include <thread>

namespace {

constexpr std::size_t MiB = std::size_t{1} << 20;

/// "VmHWM": the most memory that this process has had, in bytes.
std::size_t peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::size_t kilobytes = 0;
    if (word == "VmHWM:" && status >> kilobytes) return kilobytes * 1024;
  }
  return 0;
}

long page_faults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

/// Large in every way: parts, and bytes that are no parts.
struct Mixed {
  std::size_t n = 0;
  int hops_left = 3;
  std::vector<std::uint32_t> numbers;
  std::vector<std::string> strings;
  std::vector<std::vector<double>> parts;
  std::map<int, std::vector<std::uint32_t>> inside;
  friend bool operator==(const Mixed&, const Mixed&) = default;

  static Mixed of(std::size_t n) {
    Mixed mixed;
    mixed.n = n;
    mixed.numbers.resize(n);
    for (std::size_t i = 0; i < n; ++i)
      mixed.numbers[i] = static_cast<std::uint32_t>(i * 2654435761U);
    mixed.strings.assign(n / 500, "a string that is not attached to the message, for it may move");
    mixed.parts.resize(n % 97, std::vector<double>(n / 50, 0.5));
    mixed.inside[3] = mixed.numbers;
    return mixed;
  }
};

const std::vector<std::size_t>& sizes() {
  // Around the sizes at which a message is attached, flushed, announced, sent in a piece.
  static const std::vector<std::size_t> all{0,     1,     500,    4095,   4096,    4097,   8'000,
                                            9'000, 9'216, 10'000, 30'000, 100'000, 300'000};
  return all;
}

struct Flood {
  int n = 0;
  std::int64_t sleep_us = 0;  // of the receiver, a message
  bool asks = false;
};

class Station : public tess::Group<Station> {
 public:
  void begin_tour() {
    for (const std::size_t n : sizes()) group()[next()].send<&Station::tour>(Mixed::of(n));
  }
  void tour(Mixed mixed) {
    Mixed wanted = Mixed::of(mixed.n);
    wanted.hops_left = mixed.hops_left;
    TESS_CHECK(mixed == wanted, "a value of size ", mixed.n, " was garbled on its way");
    if (--mixed.hops_left >= 0) group()[next()].send<&Station::tour>(std::move(mixed));
  }
  void spray() {
    for (int i = 0; i < 20; ++i)
      group()[next()].send<&Station::soak>(std::vector<std::byte>(MiB / 2));
  }
  void soak(std::vector<std::byte> bytes) {
    TESS_CHECK(bytes.size() == MiB / 2, bytes.size());
    if (++n_met_ == 5) tess::exit(0);
  }

  void bounce(std::vector<std::byte> bytes, tess::Callback<int> done) {
    ++n_met_;
    if (n_met_ == 20) faults_ = page_faults();
    if (n_met_ == 120) {
      const long n = page_faults() - faults_;
      // 25 600 if each took new memory. One more vector may be alive than in the warm-up, where a
      // process sends before it hears that its last message has left: 256 pages each.
      TESS_CHECK(n < 2'000, "100 transfers of 1 MiB took ", n, " new pages");
      if (pe().value == 0) {
        done(1);
        return;
      }
    }
    group()[next()].send<&Station::bounce>(std::move(bytes), std::move(done));
  }

  /// Sends to the last PE.
  tess::Task pour(Flood flood) {
    const tess::PeId last{tess::n_pes() - 1};
    for (int i = 0; i < flood.n; ++i) {
      if (flood.asks) co_await tess::room(group()[last]);
      group()[last].send<&Station::sink>(std::vector<std::byte>(MiB, std::byte{1}), flood.sleep_us);
    }
  }
  void watch() { peak_ = peak_bytes(); }
  void sink(std::vector<std::byte> bytes, std::int64_t sleep_us) {
    TESS_CHECK(bytes.size() == MiB && bytes.front() == std::byte{1} && bytes.back() == std::byte{1},
               "a message was garbled on its way");
    std::this_thread::sleep_for(std::chrono::microseconds(sleep_us));
  }
  void within(std::size_t most_bytes) {
    const std::size_t grown = peak_bytes() - peak_;
    tess::print("PE ", pe().value, ": peak memory grew by ", grown / MiB, " MiB\n");
    TESS_CHECK(grown < most_bytes, "peak memory grew by ", grown, " bytes, not ", most_bytes);
  }

 private:
  [[nodiscard]] tess::PeId next() const { return tess::PeId{(pe().value + 1) % tess::n_pes()}; }
  int n_met_ = 0;
  long faults_ = 0;
  std::size_t peak_ = 0;
};

tess::Task values() {
  const auto stations = tess::create<Station>(tess::each_pe);
  co_await tess::epoch([&] { stations.broadcast<&Station::begin_tour>(); });
  stations.broadcast<&Station::spray>();  // ends by exit() while others are on their way
}

tess::Task memory() {
  const auto stations = tess::create<Station>(tess::each_pe);
  tess::Future<int> done;
  stations[tess::PeId{1}].send<&Station::bounce>(std::vector<std::byte>(MiB), done.callback());
  (void)co_await done;
}

/// From the first PE to the last; then each looks how far its memory has grown.
tess::Task flood(Flood flood, std::size_t most_sender, std::size_t most_receiver) {
  const auto stations = tess::create<Station>(tess::each_pe);
  const tess::PeId last{tess::n_pes() - 1};
  co_await tess::epoch([&] { stations.broadcast<&Station::watch>(); });
  co_await tess::epoch([&] { stations[tess::PeId{0}].send<&Station::pour>(flood); });
  stations[tess::PeId{0}].send<&Station::within>(most_sender);
  stations[last].send<&Station::within>(most_receiver);
}

int large(int argc, char** argv) {
  tess::Setup setup = tess::take_options(argc, argv);
  const std::string what = argc > 1 ? argv[1] : "";
  return tess::run(setup, [what]() -> tess::Task {
    if (what == "values") return values();
    if (what == "memory") return memory();
    // The bounds: the budget of 8 or 32 MiB, what malloc keeps, what MPI takes.
    if (what == "flood") return flood({400, 500, false}, 1000 * MiB, 24 * MiB);
    return flood({2000, 0, true}, 64 * MiB, 64 * MiB);
  });
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return large(argc, argv); });
}
