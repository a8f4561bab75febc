#include "runtime/command_line.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace {

/// Whether a line of the text is exactly this.
bool has_line(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

/// Reads these words after the name of the program.
bool parse(tess::CommandLine& line, std::vector<std::string> words) {
  words.insert(words.begin(), "program");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  return line.parse(static_cast<int>(arguments.size()), arguments.data());
}

/// Takes one option.
void parse(tess::CommandLine& line, const std::string& option, const std::string& value) {
  (void)parse(line, {option, value});
}

}  // namespace

TEST_CASE("the help has each option with what it takes, its range and its default",
          "[runtime][command_line]") {
  std::int32_t n_blocks = 4;
  std::int32_t n_steps = 50;
  double edge = 0;
  std::string seeds = "1:100";
  std::string when = "never";
  std::vector<std::int32_t> levels{1, 2, 4};
  std::vector<std::string> files;
  tess::CommandLine line("A program.");
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
  CHECK(has_line(help, "  --version   print the version, the commit, the compiler and MPI"));
  CHECK(help.find("--help-runtime\n              print the runtime's") != std::string::npos);
  CHECK_FALSE(has_line(help, "Runtime:"));
  CHECK(has_line(help, "  --blocks N  blocks on each axis (1 to 64; default 4)"));
  CHECK(has_line(help, "  --steps N   steps (default 50)"));
  CHECK(has_line(help, "  --seeds FROM:TO\n              both included (default 1:100)"));
  CHECK(has_line(help, "Output:\n  --edge LENGTH\n              of a voxel (default: chosen)"));
  CHECK(has_line(help, "  --when never|always\n              when it writes (default never)"));
  CHECK(has_line(help, "  --levels N  which (default 1,2,4)"));
}

TEST_CASE("the help is at most 100 columns wide", "[runtime][command_line]") {
  bool audits = false;
  std::string text;
  for (int i = 0; i < 40; ++i)
    text += "word" + std::string(static_cast<std::size_t>(i % 7), 's') + ' ';
  tess::CommandLine line("A program.");
  line.flag("--audit", audits, text);
  std::istringstream help(line.help());
  std::size_t n_lines = 0;
  std::size_t widest = 0;
  for (std::string one; std::getline(help, one); ++n_lines) widest = std::max(widest, one.size());
  CHECK(n_lines >= 6);
  CHECK(widest <= 100);
  CHECK(widest > 80);
}

TEST_CASE("a value outside of the range is refused with the range", "[runtime][command_line]") {
  std::int32_t n_blocks = 4;
  tess::CommandLine line("A program.");
  line.option("--blocks", n_blocks, "blocks on each axis").between(1, 64);
  CHECK_THROWS_WITH(parse(line, "--blocks", "65"),
                    Catch::Contains("65") && Catch::Contains("1 to 64"));
}

TEST_CASE("a real number between two whole ones is taken, and none beyond them",
          "[runtime][command_line]") {
  double factor = 0;
  std::vector<double> factors;
  tess::CommandLine line("A program.");
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

TEST_CASE("the text of a value has all of its digits", "[runtime][command_line]") {
  double width = 0.06;
  std::vector<double> centre{0.35, 1e-9};
  tess::CommandLine line("A program.");
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
          "[runtime][command_line]") {
  std::int32_t n_steps = 4;
  std::optional<std::int32_t> n_blocks;
  std::string when;
  std::vector<std::int32_t> levels;
  tess::CommandLine line("A program.");
  line.option("--steps", n_steps, "steps").between(1, 64);
  line.option("--blocks", n_blocks, "blocks");
  line.option("--when", when, "when it writes").one_of({"never", "always"});
  line.option("--levels", levels, "which");
  CHECK(parse(line, {"--steps", "3", "--blocks=7", "--when=never", "--levels", "1", "--steps", "5",
                     "--blocks", "8", "--when", "always", "--levels", "2"}));
  CHECK(n_steps == 5);
  CHECK(n_blocks == 8);
  CHECK(when == "always");
  CHECK(levels == std::vector<std::int32_t>{1, 2});
}

TEST_CASE("a whole number is decimal, and begins with no zero", "[runtime][command_line]") {
  for (const std::string wrong : {"010", "-010", "0x10", "00"}) {
    std::int32_t value = 5;
    tess::CommandLine line("A program.");
    line.option("--number", value, "a number");
    CHECK_THROWS_WITH(parse(line, "--number", wrong), Catch::Contains("begins with a zero"));
  }
  std::int32_t value = 5;
  tess::CommandLine line("A program.");
  line.option("--number", value, "a number");
  parse(line, "--number", "0");
  CHECK(value == 0);
}

TEST_CASE("an option without a sign takes no negative number, nor one beyond 64 bits",
          "[runtime][command_line]") {
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> bytes;
  std::vector<std::uint64_t> limits;
  tess::CommandLine line("A program.");
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
          "[runtime][command_line]") {
  const auto refusal = [](const std::vector<std::string>& words) {
    std::int32_t n_steps = 4;
    std::vector<std::string> fields, names;
    std::string study, pairs;
    bool checks = false;
    tess::CommandLine line("A program.");
    line.option("NAME", names, "what it runs");
    line.option("--steps", n_steps, "steps");
    line.option("--field,--fields NAMES", fields, "which").separated_by(',');
    line.option("--pairs A:B", pairs, "which").joined_by(',');
    line.option("--study WHAT", study, "what it varies").takes(0, 1);
    line.flag("--check", checks, "compare");
    REQUIRE(parse(line, words));
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

TEST_CASE("questions end the program, and one without the runtime has no --help-runtime",
          "[runtime][command_line]") {
  std::int32_t n_steps = 4;
  const auto goes_on = [&](std::vector<std::string> words, const char* runtime_help) {
    tess::CommandLine line("A program.");
    line.option("--steps", n_steps, "steps");
    std::string name = "program";
    std::vector<char*> arguments{name.data()};
    for (std::string& word : words) arguments.push_back(word.data());
    return line.parse(static_cast<int>(arguments.size()), arguments.data(), runtime_help);
  };
  for (const char* const question : {"-h", "--help", "--version", "--help-runtime"}) {
    CAPTURE(question);
    CHECK_FALSE(goes_on({question}, "Runtime:\n  --pes N\n"));
    CHECK_FALSE(goes_on({"--steps", "3", question, "--nonsense"}, "Runtime:\n  --pes N\n"));
  }
  CHECK_FALSE(goes_on({"--version"}, ""));
  CHECK_THROWS_WITH(goes_on({"--help-runtime"}, ""),
                    Catch::Contains("unknown option --help-runtime"));
  CHECK_THROWS_WITH(goes_on({"--pse"}, ""), Catch::Contains("unknown option --pse (--help"));
}

TEST_CASE("examples and the footer stand below the options", "[runtime][command_line]") {
  tess::CommandLine line("A program.");
  line.footer("Scenes:\n  planes:N  parallel planes\n");
  line.examples({"--steps 3", "planes:9 --pes 2"});
  REQUIRE(parse(line, {}));
  CHECK(has_line(line.help(),
                 "Examples:\n  program --steps 3\n  program planes:9 --pes 2\n\nScenes:"));
}

TEST_CASE("a mistyped choice is refused with the nearest one", "[runtime][command_line]") {
  std::string when;
  tess::CommandLine line("A program.");
  line.option("--when", when, "when it writes").one_of({"never", "always"});
  CHECK_THROWS_WITH(parse(line, "--when", "alwyas"),
                    Catch::Contains("alwyas not in {never,always}; did you mean always? (--help"));
  CHECK_THROWS_WITH(parse(line, "--when", "often"),
                    Catch::Contains("often not in {never,always} (--help"));
}

TEST_CASE("an unknown option is refused with the nearest one, of the program or the runtime",
          "[runtime][command_line]") {
  std::int32_t n_steps = 4;
  std::vector<std::string> fields;
  tess::CommandLine line("A program.");
  line.option("--steps", n_steps, "steps");
  line.option("--field,--fields NAMES", fields, "which");
  const auto refusal = [&](const std::string& word) {
    return tess::test::message_of([&] { (void)parse(line, {word}); });
  };
  const auto nearest = [](const std::string& typed, const std::string& meant) {
    return "unknown option " + typed + " (did you mean " + meant + "? --help lists the options)";
  };
  CHECK(refusal("--pse") == nearest("--pse", "--pes"));
  CHECK(refusal("--stpes=3") == nearest("--stpes", "--steps"));
  CHECK(refusal("-steps") == nearest("-steps", "--steps"));
  CHECK(refusal("--fildes") == nearest("--fildes", "--fields"));
  CHECK(refusal("--message-memry") == nearest("--message-memry", "--message-memory"));
  for (const std::string word : {"--nonsense", "-x", "--x"})
    CHECK(refusal(word) == "unknown option " + word + " (--help lists the options)");
}

TEST_CASE("a run refuses options that its program has not read", "[runtime][command_line]") {
  // The exit code of a program without a parser, and whether it ran.
  const auto result = [](std::vector<std::string> words, bool reads_them) {
    std::vector<char*> arguments{const_cast<char*>("mine")};
    for (std::string& word : words) arguments.push_back(word.data());
    int argc = static_cast<int>(arguments.size());
    bool ran = false;
    const int code = tess::guarded(argc, arguments.data(), [&](tess::Setup& setup) {
      if (reads_them) argc = 1;
      return tess::run(setup, [&ran] { ran = true; });
    });
    return std::pair(code, ran);
  };
  CHECK(result({"--pse", "2"}, false) == std::pair(2, false));
  CHECK(result({"file", "--pes", "1", "-x"}, false) == std::pair(2, false));
  for (const char* const question : {"--help", "-h", "--version", "--help-runtime"})
    CHECK(result({question}, false) == std::pair(0, false));
  CHECK(result({"--steps", "2"}, true) == std::pair(0, true));
  CHECK(result({"file", "-2", "--pes", "1"}, false) == std::pair(0, true));
}

TEST_CASE("a value that is needed may begin with '-', but is no option",
          "[runtime][command_line]") {
  double edge = 0;
  std::int32_t n_steps = 4;
  std::string name;
  std::string study;
  std::vector<double> velocity;
  std::vector<std::string> files;
  tess::CommandLine line("A program.");
  line.option("FILE", files, "what it reads");
  line.option("-n,--steps", n_steps, "steps");
  line.option("--edge", edge, "of a voxel");
  line.option("--name", name, "of the run");
  line.option("--study", study, "what it varies").takes(0, 1);
  line.option("--velocity VX,VY,VZ", velocity, "of the flow").separated_by(',').takes(3, 3);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--edge", "-1.5", "-n", "-3"}, {"--edge=-1.5", "-n=-3"}}) {
    CHECK(parse(line, words));
    CHECK(edge == -1.5);
    CHECK(n_steps == -3);
  }
  CHECK(parse(line, {"--velocity", "-1", "-0.5", "2", "-5", "-"}));
  CHECK(velocity == std::vector<double>{-1, -0.5, 2});
  CHECK(files == std::vector<std::string>{"-5", "-"});
  CHECK(parse(line, {"--name", "--unknown", "--study", "--steps", "7"}));
  CHECK(name == "--unknown");
  CHECK(line.is_given("--study"));
  CHECK(study.empty());
  CHECK(parse(line, {"--study", "h", "x", "--name="}));
  CHECK(study == "h");
  CHECK(files == std::vector<std::string>{"x"});
  CHECK(name.empty());

  CHECK_THROWS_WITH(parse(line, {"--name", "--steps=5"}), Catch::Contains("--name needs a value"));
  CHECK_THROWS_WITH(parse(line, {"--edge"}), Catch::Contains("--edge needs a value"));
  CHECK_THROWS_WITH(parse(line, {"--velocity", "1,2"}),
                    Catch::Contains("--velocity: takes 3 values, not 2"));
  CHECK_THROWS_WITH(parse(line, {"--velocity", "1,2,3,4"}),
                    Catch::Contains("--velocity: takes 3 values, not 4"));
}

TEST_CASE("after -- no word is an option, and arguments stand in their places",
          "[runtime][command_line]") {
  std::int32_t n_steps = 4;
  bool checks = false;
  std::string source;
  std::string target;
  tess::CommandLine line("A program.");
  line.option("SOURCE", source, "what it reads");
  line.option("TARGET", target, "what it writes");
  line.option("--steps", n_steps, "steps");
  line.flag("--check", checks, "compare");
  CHECK(parse(line, {"a", "--steps", "5", "--", "--check"}));
  CHECK(source == "a");
  CHECK(target == "--check");
  CHECK_FALSE(checks);
  CHECK_THROWS_WITH(parse(line, {"--steps", "--", "5"}), Catch::Contains("--steps needs a value"));
  CHECK_THROWS_WITH(parse(line, {"a", "--check", "b", "c"}),
                    Catch::Contains("argument 'c' is one too many"));
  CHECK_THROWS_WITH(parse(line, {"--check=yes"}),
                    Catch::Contains("--check takes no value; leave out =yes"));
}

TEST_CASE("a number that its variable cannot hold is refused", "[runtime][command_line]") {
  std::int32_t n_steps = 4;
  double edge = 0.5;
  tess::CommandLine line("A program.");
  line.option("--steps", n_steps, "steps");
  line.option("--edge", edge, "of a voxel");
  for (const char* const wrong : {"2147483648", "1.5", "1e3", "5x", "''"})
    CHECK_THROWS_WITH(parse(line, "--steps", wrong == std::string("''") ? "" : wrong),
                      Catch::Contains("--steps: ") && Catch::Contains(wrong) &&
                          Catch::Contains("is not a whole number from -2147483648 to 2147483647"));
  CHECK_THROWS_WITH(parse(line, "--edge", "1e999"),
                    Catch::Contains("--edge: 1e999 is not a number"));
  CHECK(n_steps == 4);
  CHECK(edge == 0.5);
}
