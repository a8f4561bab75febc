// The runtime's cost, figure by figure, beside what Charm++ reaches: CSV on standard output. Each
// measurement checks what it did before it prints.
//
//     bench --pes 1;  bench --pes 2;  mpirun -n 2 bench --pes 1;  mpirun -n 2 bench_mpi_raw
#include "apps/bench/measures.hpp"
#include "apps/command_line.hpp"
#include "runtime/runtime.hpp"

namespace bench {

Reach reach() {
  tess::Pe& pe = tess::current_pe();
  if (pe.n_pes() == 1) return Reach::one_pe;
  return pe.machine().same_process(tess::PeId{0}, tess::PeId{pe.n_pes() - 1}) ? Reach::one_process
                                                                              : Reach::processes;
}

namespace {

[[nodiscard]] std::string text_before(const std::string& text, const char* end) {
  return text.substr(0, text.find(end));
}

const std::vector<std::string> all_measures{
    "ping_pong", "send_cost", "creation", "collectives", "migration", "balance"};

tess::Task measure(const Report& report, std::vector<std::string> names, Options options) {
  report.header();
  const bool alone = reach() == Reach::one_pe;
  for (const std::string& name : names) {
    if (name == "ping_pong" && !alone) co_await ping_pong(report, options);
    if (name == "send_cost") co_await send_cost(report, options);
    if (name == "creation") co_await creation(report, options);
    if (name == "collectives") co_await collectives(report, options);
    if (name == "migration" && !alone) co_await migration(report, options);
    if (name == "balance") co_await balance(report, options);
  }
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    bench::Options options;
    std::vector<std::string> names = bench::all_measures;
    apps::CommandLine line("The cost of messages, creation, collectives and migration.");
    line.option("measures", names, "which (all by default; some need two PEs)")
        .one_of(bench::all_measures);
    line.option("--repeat", options.repeat, "how often each is measured").between(1, 1000);
    line.option("--elements", options.elements, "of send_cost's array").between(1, 10'000'000);
    if (!line.parse(argc, argv)) return 0;
    const std::string machine = setup.machine->describe();
    const bench::Report report(bench::text_before(bench::text_before(machine, ";"), " on "));
    return tess::run(setup, [&] { return bench::measure(report, names, options); });
  });
}
