#include "apps/command_line.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

/// Whether a line of the text is exactly this.
bool has_line(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

/// Takes one option.
void parse(apps::CommandLine& line, std::string option, std::string value) {
  std::array<std::string, 3> words{"program", std::move(option), std::move(value)};
  std::array<char*, 3> arguments{words[0].data(), words[1].data(), words[2].data()};
  (void)line.parse(3, arguments.data());
}

}  // namespace

TEST_CASE("the help has each option with what it takes, its range and its default",
          "[apps][command_line]") {
  std::int32_t n_blocks = 4;
  std::int32_t n_steps = 50;
  double edge = 0;
  std::string seeds = "1:100";
  std::string when = "never";
  std::vector<std::int32_t> levels{1, 2, 4};
  std::vector<std::string> files;
  apps::CommandLine line("A program.");
  line.option("FILE", files, "what it reads");
  line.option("--blocks", n_blocks, "blocks on each axis").between(1, 64);
  line.option("--steps", n_steps, "steps").between(1, 1'000'000'000);
  line.option("--seeds FROM:TO", seeds, "both included");
  line.group("Output");
  line.option("--edge LENGTH", edge, "of a voxel (default: chosen)").positive();
  line.option("--when", when, "when it writes").one_of({"never", "always"});
  line.option("--levels", levels, "which").separated_by(',');
  const std::string help = line.help();
  CAPTURE(help);
  CHECK(has_line(help, "Arguments:\n  FILE...     what it reads"));
  CHECK(has_line(help, "Options:\n  -h,--help   print this text"));
  CHECK(has_line(help, "  --blocks N  blocks on each axis (1 to 64; default 4)"));
  CHECK(has_line(help, "  --steps N   steps (default 50)"));
  CHECK(has_line(help, "  --seeds FROM:TO\n              both included (default 1:100)"));
  CHECK(has_line(help, "Output:\n  --edge LENGTH\n              of a voxel (default: chosen)"));
  CHECK(has_line(help, "  --when never|always\n              when it writes (default never)"));
  CHECK(has_line(help, "  --levels N  which (default 1,2,4)"));
}

TEST_CASE("the help is at most 100 columns wide", "[apps][command_line]") {
  bool audits = false;
  std::string text;
  for (int i = 0; i < 40; ++i)
    text += "word" + std::string(static_cast<std::size_t>(i % 7), 's') + ' ';
  apps::CommandLine line("A program.");
  line.flag("--audit", audits, text);
  std::istringstream help(line.help());
  std::size_t n_lines = 0;
  std::size_t widest = 0;
  for (std::string one; std::getline(help, one); ++n_lines) widest = std::max(widest, one.size());
  CHECK(n_lines >= 6);
  CHECK(widest <= 100);
  CHECK(widest > 80);
}

TEST_CASE("a value outside of the range is refused with the range", "[apps][command_line]") {
  std::int32_t n_blocks = 4;
  apps::CommandLine line("A program.");
  line.option("--blocks", n_blocks, "blocks on each axis").between(1, 64);
  char program[] = "program";
  char name[] = "--blocks";
  char value[] = "65";
  char* argv[] = {program, name, value};
  CHECK_THROWS_WITH(line.parse(3, argv), Catch::Contains("65") && Catch::Contains("1 to 64"));
}

TEST_CASE("a real number between two whole ones is taken, and none beyond them",
          "[apps][command_line]") {
  double factor = 0;
  std::vector<double> factors;
  apps::CommandLine line("A program.");
  line.option("--factor", factor, "of the law").between(0, 2);
  line.option("--factors", factors, "of the laws").separated_by(',').between(0, 2);
  CHECK(has_line(line.help(), "  --factor X  of the law (0 to 2)"));
  for (const char* const value : {"0", "0.5", "1e-3", "2"}) {
    CAPTURE(value);
    parse(line, "--factor", value);
    CHECK(factor == std::stod(value));
  }
  parse(line, "--factors", "0.25,1.5");
  CHECK(factors == std::vector<double>{0.25, 1.5});
  for (const char* const value : {"-0.1", "2.001", "nan", "inf", "two"}) {
    CAPTURE(value);
    CHECK_THROWS_WITH(parse(line, "--factor", value), Catch::Contains("--factor: Value ") &&
                                                          Catch::Contains(value) &&
                                                          Catch::Contains("not in range 0 to 2"));
  }
}

TEST_CASE("the text of a value has all of its digits", "[apps][command_line]") {
  double width = 0.06;
  std::vector<double> centre{0.35, 1e-9};
  apps::CommandLine line("A program.");
  line.option("--width", width, "of the front");
  line.option("--centre", centre, "of the front").separated_by(',');
  CHECK(line.value("--width") == "0.06");
  CHECK(line.value("--centre") == "0.35,1e-09");
  CHECK(has_line(line.help(), "  --width X   of the front (default 0.06)"));
  CHECK(has_line(line.help(), "  --centre X  of the front (default 0.35,1e-09)"));
  parse(line, "--width", "0.0600000003");
  parse(line, "--centre", "0.350000001,2");
  CHECK(line.value("--width") == "0.0600000003");
  CHECK(line.value("--centre") == "0.350000001,2");
}

TEST_CASE("the last value of an option that is given again counts, and a list has all",
          "[apps][command_line]") {
  std::int32_t n_steps = 4;
  std::optional<std::int32_t> n_blocks;
  std::string when;
  std::vector<std::int32_t> levels;
  apps::CommandLine line("A program.");
  line.option("--steps", n_steps, "steps").between(1, 64);
  line.option("--blocks", n_blocks, "blocks");
  line.option("--when", when, "when it writes").one_of({"never", "always"});
  line.option("--levels", levels, "which");
  std::vector<std::string> words{"program",  "--steps", "3",       "--blocks=7", "--when=never",
                                 "--levels", "1",       "--steps", "5",          "--blocks",
                                 "8",        "--when",  "always",  "--levels",   "2"};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  CHECK(line.parse(static_cast<int>(arguments.size()), arguments.data()));
  CHECK(n_steps == 5);
  CHECK(n_blocks == 8);
  CHECK(when == "always");
  CHECK(levels == std::vector<std::int32_t>{1, 2});
}

TEST_CASE("a whole number is decimal, and begins with no zero", "[apps][command_line]") {
  for (const std::string wrong : {"010", "-010", "0x10", "00"}) {
    std::int32_t value = 5;
    apps::CommandLine line("A program.");
    line.option("--number", value, "a number");
    CHECK_THROWS_WITH(parse(line, "--number", wrong), Catch::Contains("begins with a zero"));
  }
  std::int32_t value = 5;
  apps::CommandLine line("A program.");
  line.option("--number", value, "a number");
  parse(line, "--number", "0");
  CHECK(value == 0);
}

TEST_CASE("an option without a sign takes no negative number, nor one beyond 64 bits",
          "[apps][command_line]") {
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> bytes;
  std::vector<std::uint64_t> limits;
  apps::CommandLine line("A program.");
  line.option("--seed", seed, "of the work");
  line.option("--bytes", bytes, "of a message");
  line.option("--limits", limits, "of PEs").separated_by(',');
  for (const char* const option : {"--seed", "--bytes", "--limits"}) {
    CAPTURE(option);
    for (const char* const value : {"-1", "18446744073709551616"})
      CHECK_THROWS_WITH(
          parse(line, option, value),
          Catch::Contains(option) && Catch::Contains(value) &&
              Catch::Contains("is not a whole number from 0 to 18446744073709551615"));
  }
  CHECK_THROWS_WITH(parse(line, "--limits", "5,-1"), Catch::Contains("-1 is not a whole number"));
  parse(line, "--limits", "5,18446744073709551615");
  CHECK(limits == std::vector<std::uint64_t>{5, 18446744073709551615U});
}

TEST_CASE("an option that another leaves unused is refused with the value given",
          "[apps][command_line]") {
  const auto refusal = [](std::vector<std::string> words) {
    std::int32_t n_steps = 4;
    std::vector<std::string> fields, names;
    std::string study, pairs;
    bool checks = false;
    apps::CommandLine line("A program.");
    line.option("NAME", names, "what it runs");
    line.option("--steps", n_steps, "steps");
    line.option("--field,--fields NAMES", fields, "which").separated_by(',');
    line.option("--pairs A:B", pairs, "which").joined_by(',');
    line.option("--study WHAT", study, "what it varies").takes(0, 1);
    line.flag("--check", checks, "compare");
    words.insert(words.begin(), "program");
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    REQUIRE(line.parse(static_cast<int>(arguments.size()), arguments.data()));
    return tess::test::message_of([&] {
      line.refuse_beside("--other, which stands still",
                         {"NAME", "--steps", "--fields", "--pairs", "--study", "--check"});
    });
  };
  const std::string other =
      " does not work with --other, which stands still; leave one of them out";
  CHECK(refusal({}).empty());
  CHECK(refusal({"--steps", "5"}) == "--steps 5" + other);
  CHECK(refusal({"--steps", "5", "--steps=4"}) == "--steps 4" + other);
  CHECK(refusal({"--field", "a,b", "--fields", "c"}) == "--fields a,b,c" + other);
  CHECK(refusal({"--pairs", "A:B", "--pairs", "B:C"}) == "--pairs A:B,B:C" + other);
  CHECK(refusal({"--study", "h"}) == "--study h" + other);
  CHECK(refusal({"--study"}) == "--study" + other);
  CHECK(refusal({"--check"}) == "--check" + other);
  CHECK(refusal({"one", "two"}) == "NAME one,two" + other);
}
