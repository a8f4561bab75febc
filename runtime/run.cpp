#include "runtime/run.hpp"

#include "runtime/arrays/elements/element.hpp"
#include "runtime/base/option_words.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/number.hpp"
#include "runtime/pe/interfaces/process_monitor.hpp"
#include "runtime/pe/interfaces/seed_search.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/pe/runtime.hpp"
#include "runtime/version.hpp"
#include "runtime/watch/service/service.hpp"
#include "runtime/wire/machine/mpi.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "runtime/wire/machine/threads.hpp"

#include <cctype>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tess {
namespace {

/// Each PE is a thread; far more of them than cores only wait for each other.
constexpr std::int32_t most_pes = 4096;

std::int32_t number_of_pes(std::string_view value) {
  const auto number = parse_number<std::int32_t>(value);
  if (!number || *number < 1 || *number > most_pes)
    fail(ErrorCode::bad_argument, "--pes: ", value, " is not a whole number from 1 to ", most_pes,
         "; --sim pes=N simulates more");
  return *number;
}

/// "64MiB": bytes, KiB, MiB or GiB.
std::size_t memory_size(std::string_view option, std::string_view value) {
  std::string_view unit = value;
  const std::size_t number = take_number<std::size_t>(unit).value_or(0);
  const int shift = unit.empty()    ? 0
                    : unit == "KiB" ? 10
                    : unit == "MiB" ? 20
                    : unit == "GiB" ? 30
                                    : -1;
  constexpr std::size_t most = std::size_t{1} << 40U;
  if (shift < 0 || number == 0 || number > most >> shift)
    fail(ErrorCode::bad_argument, option, ": ", value,
         " is not a size of 1 byte to 1024 GiB: write it as 64MiB (KiB, MiB, GiB, or bytes)");
  return number << shift;
}

/// "8080", "0.0.0.0:8080", "[::1]:8080".
MonitorOptions monitor_options(std::string_view value, std::string_view token) {
  if (detail::make_monitor == nullptr)
    fail(ErrorCode::bad_argument, "--monitor ", value,
         ": this program has no live view; link it with Tessera::live_view");
  MonitorOptions options;
  options.token = token;
  std::string_view port = value;
  if (const std::size_t colon = value.rfind(':'); colon != std::string_view::npos) {
    std::string_view address = value.substr(0, colon);
    if (address.starts_with('[') && address.ends_with(']'))
      address = address.substr(1, address.size() - 2);
    if (address != "localhost") options.address = address;
    port = value.substr(colon + 1);
  }
  const auto number = parse_number<std::uint16_t>(port);
  if (!number)
    fail(ErrorCode::bad_argument, "--monitor ", value,
         " is not a port of 0 … 65535, or ADDRESS:PORT");
  options.port = *number;
  // It stands in addresses, where other characters mean something.
  for (const char c : token)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '.' && c != '_')
      fail(ErrorCode::bad_argument, "--monitor-token ", token, ": '", std::string_view(&c, 1),
           "' cannot be in a token: use letters, digits, '-', '.' and '_'");
  const bool is_loopback = options.address.starts_with("127.") || options.address == "::1";
  if (!is_loopback && token.empty())
    fail(ErrorCode::bad_argument, "--monitor ", value,
         ": other machines can reach this address: give a --monitor-token that they must know");
  return options;
}

/// "2.5": a time above 0.
std::chrono::nanoseconds number_of_seconds(std::string_view option, std::string_view value) {
  const auto number = parse_number<double>(value);
  constexpr double least = 1e-6, most = 1e9;
  if (!number || !(*number >= least && *number <= most))
    fail(ErrorCode::bad_argument, option, ": ", value,
         " is not a number of seconds of 0.000001 to 1000000000");
  return std::chrono::nanoseconds(static_cast<std::int64_t>(*number * 1e9));
}

const char* name_of_program(const char* path) {
  const char* const slash = std::strrchr(path, '/');
  return slash != nullptr ? slash + 1 : path;
}

void print_error(const char* program, const Error& error) {
  std::fprintf(stderr, "%s: error: %s\n", name_of_program(program), one_line(error.what()).c_str());
  std::fflush(stderr);
}

/// The exit code of a program, unless what it printed is lost, on a full disk for instance.
int printed(const char* program, int code) {
  if (code != 0 || (std::fflush(stdout) == 0 && std::ferror(stdout) == 0)) return code;
  print_error(program, Error(ErrorCode::environment,
                             "standard output: a part of it could not be written; check that its "
                             "disk has room"));
  return 2;
}

/// Memory was exhausted outside of any message: while input was read or results were written.
const Error& out_of_memory() {
  static const Error error(ErrorCode::environment,
                           "memory is exhausted; ask for less, or give this machine more");
  return error;
}

void refuse_inside_run() {
  TESS_CHECK(detail::current_pe_or_null() == nullptr,
             "run() is called inside a run: a program has one run at a time");
}

/// True if other processes may belong to this run.
bool is_in_job() {
  return under_mpirun() || program_owns_mpi();
}

/// The words of the command line that guarded() gave to its body, until they are read.
struct Unread {
  const int* argc = nullptr;
  char** argv = nullptr;
};
Unread unread;

/// True if a word that no parser has read asks for the help or the version, which is then printed.
/// Throws for any other option: it would be ignored.
bool asks_for_help() {
  if (unread.argc == nullptr) return false;
  for (int i = 1; i < *unread.argc; ++i) {
    const std::string_view word = unread.argv[i];
    if (!detail::looks_like_option(word)) continue;
    const bool asks_for_version = word == "--version";
    if (!asks_for_version && word != "--help" && word != "-h" && word != "--help-runtime")
      detail::refuse_unknown_option(detail::name_in(word), options_help());
    if (speaks_for_job())
      print(asks_for_version ? version_text(name_of_program(unread.argv[0]))
                             : text("usage: ", unread.argv[0], " [options]\n", options_help()));
    return true;
  }
  return false;
}

/// The number that a process that refuses its input passes to Machine::agree(); others pass one
/// that the fingerprint of the program gives.
constexpr std::uint64_t refused = 0x7265667573656421U;

/// Handles an Error before the run. If all processes have one, process 0 prints it. Otherwise the
/// other processes wait at the start of the run, and this process ends the job.
void refuse(Setup& setup, int& argc, char** argv, const Error& error) {
  unread = {};
  if (!setup.machine && is_in_job()) {
    try {
      setup.machine = make_mpi_machine(argc, argv, {.pes_per_process = 0, .refuses = true});
    } catch (const Error&) {  // then each process prints its own
    }
  }
  if (!setup.machine || setup.started) return print_error(argv[0], error);
  const bool all = setup.machine->agree(refused);
  if (!all || setup.machine->process().value == 0) print_error(argv[0], error);
  if (!all) setup.machine->abort(2);
  // mpirun ends the others when a process leaves: wait until the line is printed.
  (void)setup.machine->agree(refused);
}

/// What the command line says about the machine.
struct MachineChoice {
  std::int32_t pes = 0;  ///< 0: not given
  std::optional<std::string> simulated{};
};

/// Moves the runtime's options from the command line to `options` and to what it returns.
MachineChoice take_values(int& argc, char** argv, RuntimeOptions& options) {
  MachineChoice choice;
  std::optional<std::string_view> monitor;
  std::string_view token;
  int kept = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string_view option = argv[i];
    std::string_view value;
    const auto takes_value = [&](std::string_view name) {  // --name value, or --name=value
      if (option == name) {
        if (++i >= argc) fail(ErrorCode::bad_argument, name, " needs a value");
        value = argv[i];
        return true;
      }
      if (!option.starts_with(name) || !option.substr(name.size()).starts_with('=')) return false;
      value = option.substr(name.size() + 1);
      return true;
    };
    if (takes_value("--pes")) {
      choice.pes = number_of_pes(value);
    } else if (takes_value("--sim")) {
      choice.simulated = value;
    } else if (takes_value("--message-memory")) {
      options.messages.memory_bytes = memory_size("--message-memory", value);
    } else if (takes_value("--trace")) {
      if (value.empty()) fail(ErrorCode::bad_argument, "--trace needs the name of a file");
      options.trace = value;
    } else if (takes_value("--monitor")) {
      monitor = value;
    } else if (takes_value("--monitor-token")) {
      token = value;
    } else if (takes_value("--hang-report")) {
      options.hang_report = number_of_seconds("--hang-report", value);
    } else if (option == "--audit") {
      options.audit = true;
    } else if (option == "--stats") {
      options.statistics = true;
    } else {
      argv[kept++] = argv[i];
    }
  }
  argc = kept;
  if (!monitor && !token.empty())
    fail(ErrorCode::bad_argument, "--monitor-token ", token, " is for --monitor, which is missing");
  if (monitor) options.monitor = monitor_options(*monitor, token);
  return choice;
}

/// The seeds of --sim seeds=FIRST..LAST, which stays in the command line.
std::optional<detail::SeedRange> seeds_of(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    std::optional<std::string> keys;
    if (word == "--sim" && i + 1 < argc) keys = argv[i + 1];
    if (word.starts_with("--sim=")) keys = word.substr(6);
    if (keys && keys->find("seeds=") != std::string::npos) return parse_simulated(*keys).seeds;
  }
  return std::nullopt;
}

}  // namespace

std::string options_help() {
  std::string text =
      "Runtime:\n"
      "  --pes N     PEs per process (default: one per core)\n"
      "  --sim KEYS  run on a simulated machine: "
      "pes=8,per-process=2,latency=2us,bandwidth=10GB/s,cost=100ns,\n"
      "              seed=7 (adversarial delivery order), migrate=0.1 (forced migrations),\n"
      "              seeds=1..200 (once per seed: which order of messages prints something "
      "else?),\n"
      "              compare=WORD (compares only this word and what follows it on a line),\n"
      "              file=FILE (the machine that bench --calibrate FILE measured)\n"
      "  --message-memory SIZE\n"
      "              most bytes of messages under way from one process to another (default "
      "32MiB);\n"
      "              later messages wait at their sender\n"
      "  --hang-report SECONDS\n"
      "              report what waits when no entry method has begun for so long, and which "
      "entry methods\n"
      "              take so long; SIGUSR1 asks for the report at any time\n"
      "  --audit     count the messages between PEs at both ends, and name those that were lost "
      "or arrived\n"
      "              twice\n"
      "  --stats     print the counters of each PE: messages, bytes, busy and idle seconds, "
      "chares\n"
      "              (time that other programs took from a PE counts as idle)\n"
      "  --trace F   write what each PE ran, and which send caused it, as JSON for Perfetto or\n"
      "              chrome://tracing, and print the critical path\n"
      "  --version   print the version, the commit, the compiler and MPI\n";
  if (detail::make_monitor != nullptr)
    text +=
        "  --monitor [ADDRESS:]PORT\n"
        "              serve a page that shows the run while it goes on (port 0: any free one)\n"
        "  --monitor-token T\n"
        "              what a browser must bring (?token=T); needed for an address that others "
        "can reach\n";
  return text;
}

Setup take_options(int& argc, char** argv) {
  refuse_inside_run();
  Setup setup;
  const MachineChoice choice = take_values(argc, argv, setup.options);
  if (setup.options.audit && !setup.options.trace.empty())
    fail(ErrorCode::bad_argument, "--audit --trace ", setup.options.trace,
         ": both number the messages; run the program once with each");
  if (choice.simulated && choice.pes != 0)
    fail(ErrorCode::bad_argument, "--sim ", *choice.simulated, " --pes ", choice.pes,
         ": the simulated machine has the PEs of its keys; leave --pes out, and write --sim pes=",
         choice.pes, ",…");
  if (choice.simulated && processes_of_job() != 1)
    fail(ErrorCode::bad_argument, "--sim ", *choice.simulated,
         ": each process of the job would simulate the whole machine; start the program without "
         "mpirun, and write --sim pes=N,per-process=M,… for processes of M PEs");
  if (choice.simulated) {
    SimulatedOptions options = parse_simulated(*choice.simulated);
    if (detail::disturb != nullptr) {
      (*detail::disturb)(options, setup.options);
    } else if (options.seeds) {
      fail(ErrorCode::bad_argument, "--sim seeds=", options.seeds->first, "..", options.seeds->last,
           ": this program does not start by tess::run(argc, argv, …) or tess::guarded()");
    }
    setup.machine = make_simulated_machine(options);
    setup.options.seed = options.seed.value_or(1);
    if (detail::disturb == nullptr) setup.options.migration_chance = migration_chance(options);
  } else if (is_in_job()) {
    setup.machine = make_mpi_machine(argc, argv, MpiOptions{.pes_per_process = choice.pes});
  } else {
    setup.machine = make_threads_machine(choice.pes);
  }
  return setup;
}

int run_on(Setup& setup, std::function<void()> main) {
  refuse_inside_run();
  if (asks_for_help()) return 0;
  TESS_CHECK(!setup.started, "run() with a Setup that has run: make one for each run");
  detail::Runtime runtime(
      *setup.machine, setup.options,
      {&detail::element_text, &detail::element_key, &detail::element_state, &detail::element_load},
      std::move(main));
  detail::Service service(runtime, setup.options.signals);
  runtime.serve(service);
  std::unique_ptr<detail::ProcessMonitor> monitor;
  if (setup.options.monitor) monitor = detail::make_monitor(runtime, *setup.options.monitor);
  runtime.prepare();
  setup.started = true;  // before it, a process that throws tells the others: refuse()
  return runtime.run();
}

int guarded(const char* program, const std::function<int()>& body) {
  try {
    return printed(program, body());
  } catch (const Error& error) {
    print_error(program, error);
    return 2;
  } catch (const std::bad_alloc&) {
    print_error(program, out_of_memory());
    return 2;
  }
}

int guarded(int& argc, char** argv, const std::function<int(Setup&)>& body) {
  Setup setup;
  try {
    const bool may_search = detail::disturb == nullptr && processes_of_job() == 1;
    if (const auto seeds = may_search ? seeds_of(argc, argv) : std::nullopt) {
      if (detail::search_seeds == nullptr)
        fail(ErrorCode::bad_argument, "--sim seeds=", seeds->first, "..", seeds->last,
             ": this program has no search for races; link it with Tessera::testing");
      return detail::search_seeds(*seeds, [&] { return guarded(argc, argv, body); });
    }
    setup = take_options(argc, argv);
    unread = {&argc, argv};
    const int code = body(setup);
    unread = {};
    return printed(argv[0], code);
  } catch (const Error& error) {
    refuse(setup, argc, argv, error);
    return 2;
  } catch (const std::bad_alloc&) {
    refuse(setup, argc, argv, out_of_memory());
    return 2;
  }
}

namespace detail {
void words_are_read() {
  unread = {};
}

void refuse_words(int argc, char** argv) {
  for (const std::string_view word : std::span(argv, static_cast<std::size_t>(argc)).subspan(1)) {
    if (looks_like_option(word)) return;  // asks_for_help() has its say
    fail(ErrorCode::bad_argument, "argument '", word,
         "' is one too many; leave it out (--help lists the options)");
  }
}
}  // namespace detail

bool charge(std::chrono::nanoseconds work) {
  TESS_CHECK(work.count() >= 0, "charge(", work.count(), "ns): work takes time");
  Pe& pe = current_pe();
  pe.machine().charge(pe.id(), work);
  return pe.machine().virtual_time();
}

void exit(int code) {
  TESS_CHECK(code >= 0 && code <= 255, "exit(", code, "): an exit code is a number of 0 … 255");
  Pe& pe = current_pe();
  pe.runtime().exit(pe, code);
}

void print_text(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

}  // namespace tess
