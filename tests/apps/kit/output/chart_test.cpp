// Reads back the files of the plot library: the CSV has the data bit for bit; the SVG is
// well-formed and has a curve per series, for any name of a series.
#include "apps/kit/output/chart.hpp"

#include "apps/kit/output/axis.hpp"
#include "apps/kit/output/file_names.hpp"
#include "apps/kit/output/quoting.hpp"
#include "apps/kit/output/style.hpp"
#include "apps/kit/output/timeline.hpp"
#include "apps/kit/output/write_file.hpp"
#include "tests/apps/xml.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

using namespace kit;
using tess::test::message_of, tess::test::read_xml, tess::test::Scratch, tess::test::slurp,
    tess::test::XmlElement;

namespace {

constexpr const char* wild = "a&b <c> \"d\", 'e' \\n _x^y{z} @k %d `date` &amp; ]]> é #;";

/// The fields of each line of a CSV file (RFC 4180).
std::vector<std::vector<std::string>> read_csv(const std::string& text) {
  std::vector<std::vector<std::string>> lines(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"')
      lines.back().back() += text[++i];
    else if (c == '"')
      quoted = !quoted;
    else if (!quoted && c == ',')
      lines.back().emplace_back();
    else if (!quoted && c == '\n')
      lines.push_back({""});
    else
      lines.back().back() += c;
  }
  lines.pop_back();
  return lines;
}

bool has_gnuplot() {
  return std::system("command -v gnuplot >/dev/null") == 0;
}

template <class Wanted>
std::ptrdiff_t count(const std::vector<XmlElement>& elements, Wanted wanted) {
  return std::count_if(elements.begin(), elements.end(), wanted);
}
std::ptrdiff_t n_texts(const std::vector<XmlElement>& elements, const std::string& text) {
  return count(elements, [&](const XmlElement& e) { return e.text.find(text) != text.npos; });
}

Chart two_series() {
  Chart chart{.title = wild, .x_label = "seconds <s>", .y_label = "L2 & Linf"};
  chart.series.push_back({wild, {{0.1, 1.0 / 3}, {1e-300, 2}, {0.7, -1e17}}});
  chart.series.push_back({"two", {{1, 2}, {2, 3}}, Style::dashes});
  return chart;
}

}  // namespace

TEST_CASE("the CSV of a chart has its data bit for bit", "[apps][plot]") {
  const Scratch scratch;
  const Chart chart = two_series();
  write_svg(scratch.path("a.svg"), chart);
  const auto lines = read_csv(slurp(scratch.path("a.csv")));
  REQUIRE(lines.size() == 6);
  CHECK(lines[0] == std::vector<std::string>{"series", "x", "y"});
  std::size_t line = 1;
  for (const Series& series : chart.series) {
    for (const Point& p : series.points) {
      REQUIRE(lines[line].size() == 3);
      CHECK(lines[line][0] == series.name);
      CHECK(std::strtod(lines[line][1].c_str(), nullptr) == p.x);
      CHECK(std::strtod(lines[line][2].c_str(), nullptr) == p.y);
      ++line;
    }
  }
}

TEST_CASE("the SVG of a chart has a curve per series, and every text unchanged",
          "[apps][plot][.][gnuplot]") {
  const Scratch scratch;
  REQUIRE(write_svg(scratch.path("a.svg"), two_series()));
  const auto elements = read_xml(slurp(scratch.path("a.svg")));
  CHECK(count(elements, [](const XmlElement& e) {
          return e.attributes.find("id=\"gnuplot_plot_") != std::string::npos;
        }) == 2);
  CHECK(n_texts(elements, wild) == 2);  // the title and the key
  CHECK(n_texts(elements, "seconds <s>") == 1);
  CHECK(n_texts(elements, "L2 & Linf") == 1);
}

TEST_CASE("points that do not fit on the axes are left out, and the others are drawn",
          "[apps][plot]") {
  const Scratch scratch;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Chart chart{.title = "logarithms", .x_log = true, .y_log = true};
  chart.series.push_back({"none", {{0, 1}, {1, 0}, {nan, 1}}});
  CHECK_FALSE(write_svg(scratch.path("a.svg"), chart));
  CHECK(scratch.n_files() == 1);  // the data
  CHECK(read_csv(slurp(scratch.path("a.csv"))).size() == 4);
  chart.series.push_back({"one", {{0.25, 1e-9}, {1, -1}}});
  chart.x_ticks = {0.25, 0.5};
  CHECK(write_svg(scratch.path("a.svg"), chart) == has_gnuplot());
  if (has_gnuplot()) CHECK(n_texts(read_xml(slurp(scratch.path("a.svg"))), "0.25") == 1);
}

TEST_CASE("a logarithmic axis is labelled at its ends, too", "[apps][plot][.][gnuplot]") {
  const Scratch scratch;
  // Edge lengths of two boxes: their logarithms are rounded towards each other.
  Chart chart{.title = "ends", .x_log = true};
  chart.x_ticks = {0.12500000000000006, 0.24999999999999997};
  chart.series.push_back({"edges", {{chart.x_ticks[0], 7}, {chart.x_ticks[1], 8}}});
  REQUIRE(write_svg(scratch.path("a.svg"), chart));
  const auto elements = read_xml(slurp(scratch.path("a.svg")));
  CHECK(n_texts(elements, "0.125") == 1);
  CHECK(n_texts(elements, "0.25") == 1);
}

TEST_CASE("no two labels of an axis are equal, and whole numbers have all their digits",
          "[apps][plot][.][gnuplot]") {
  const Scratch scratch;
  Chart chart{.title = "digits", .x_log = true};
  chart.x_ticks = {1024, 2048};
  chart.series.push_back({"flat", {{1024, 10.01}, {2048, 10.055}}});
  REQUIRE(write_svg(scratch.path("a.svg"), chart));
  std::vector<std::string> labels;
  for (const XmlElement& e : read_xml(slurp(scratch.path("a.svg"))))
    if (e.name == "text" && e.text.find_first_of("0123456789") != std::string::npos)
      labels.push_back(e.text);
  CHECK(std::count(labels.begin(), labels.end(), "1\u2009024") == 1);
  CHECK(std::count(labels.begin(), labels.end(), "2\u2009048") == 1);
  std::sort(labels.begin(), labels.end());
  CHECK(std::adjacent_find(labels.begin(), labels.end()) == labels.end());
}

TEST_CASE("numbers of axes are written as readers write them", "[apps][plot]") {
  CHECK(number_text(0) == "0");
  CHECK(number_text(-0.0) == "0");
  CHECK(number_text(16) == "16");
  CHECK(number_text(1000) == "1\u2009000");
  CHECK(number_text(-65536) == "-65\u2009536");
  CHECK(number_text(1048576) == "1\u2009048\u2009576");
  CHECK(number_text(2e6) == "2·10⁶");
  CHECK(number_text(1e-12) == "10⁻¹²");
  CHECK(number_text(-1e17) == "-10¹⁷");
  CHECK(number_text(0.05) == "0.05");
  CHECK(number_text(1234.5) == "1\u2009234");
}

TEST_CASE("axes are labelled at the counts, at decades or at round numbers", "[apps][plot]") {
  const auto labels = [](const Axis& axis) {
    std::string all;
    for (const auto& [at, text] : axis.ticks) all += (all.empty() ? "" : " ") + text;
    return all;
  };
  CHECK(labels(axis_of({4, 1, 16, 2, 8, 4}, true, {}, false)) == "1 2 4 8 16");
  CHECK(labels(axis_of({1e-5, 3, 0.2}, true, {}, false)) == "10⁻⁵ 10⁻⁴ 0.001 0.01 0.1 1 10");
  CHECK(labels(axis_of({0.03, 0.4}, true, {}, false)) == "0.02 0.05 0.1 0.2 0.5");
  CHECK(labels(axis_of({1.5, 2.5}, true, {}, false)) == "1.4 1.6 1.8 2 2.2 2.4 2.6");
  CHECK(labels(axis_of({15, 71}, false, {}, true)) == "0 10 20 30 40 50 60 70 80");
  CHECK(labels(axis_of({65, 71}, false, {}, true)) == "65 66 67 68 69 70 71");
  CHECK(labels(axis_of({0, 318}, false, {}, false)) == "0 50 100 150 200 250 300");
  CHECK(axis_of({0, 318}, false, {}, false).high == 318);
  CHECK(labels(axis_of({3, 3}, false, {0.125, 4}, false)) == "0.125 4");
  CHECK(labels(axis_of({5}, false, {}, false)).find('5') != std::string::npos);
  CHECK(axis_of({1, 100}, true, {}, false).part(10) == Approx(0.5));
  CHECK(axis_of({0, 8}, false, {}, false).part(2) == Approx(0.25));
}

TEST_CASE("the first five colours differ in grey", "[apps][plot]") {
  std::vector<double> greys;
  for (std::size_t i = 0; i < 5; ++i) {
    double luminance = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double part =
          std::stoi(std::string(colours[i]).substr(1 + 2 * k, 2), nullptr, 16) / 255.0;
      luminance += std::array{0.2126, 0.7152, 0.0722}[k] * std::pow((part + 0.055) / 1.055, 2.4);
    }
    greys.push_back(116 * std::cbrt(std::max(luminance, 0.0089)) - 16);  // CIE lightness
  }
  std::sort(greys.begin(), greys.end());
  for (std::size_t i = 1; i < greys.size(); ++i) CHECK(greys[i] - greys[i - 1] > 6);
}

TEST_CASE("the key is where no curve is", "[apps][plot][.][gnuplot]") {
  const Scratch scratch;
  // The place of the key's text, in pixels of 720 × 480.
  const auto key_of = [&](const std::vector<Point>& points) {
    Chart chart{.title = "t", .series = {{"a name of a curve", points}}};
    REQUIRE(write_svg(scratch.path("a.svg"), chart));
    const std::string svg = slurp(scratch.path("a.svg"));
    const std::size_t text = svg.find("a name of a curve", svg.find("</title>"));
    const std::size_t at = svg.rfind("translate(", text) + 10;
    return Point{std::strtod(svg.c_str() + at, nullptr),
                 std::strtod(svg.c_str() + svg.find(',', at) + 1, nullptr)};
  };
  const Point falling = key_of({{0, 1}, {1, 0}}), rising = key_of({{0, 0}, {1, 1}});
  CHECK((falling.x > 360 && falling.y < 240));
  CHECK((rising.x < 360 && rising.y < 240));
  const Point bent = key_of({{0, 0}, {0, 1}, {1, 1}});
  CHECK((bent.x > 360 && bent.y > 240));
  const Point none = key_of({{0, 0}, {0, 1}, {1, 1}, {1, 0}, {0, 0}});
  CHECK(none.x > falling.x);  // beside the plot
}

TEST_CASE("repeated measurements have bars, and stand in the CSV", "[apps][plot]") {
  const Scratch scratch;
  Chart chart{.title = "bars"};
  chart.series.push_back({"runs", {{1, 2, 1.5, 3}, {2, 4}}});
  CHECK(write_svg(scratch.path("a.svg"), chart) == has_gnuplot());
  const auto lines = read_csv(slurp(scratch.path("a.csv")));
  REQUIRE(lines.size() == 3);
  CHECK(lines[0] == std::vector<std::string>{"series", "x", "y", "low", "high"});
  CHECK(lines[1] == std::vector<std::string>{"runs", "1", "2", "1.5", "3"});
  CHECK(lines[2] == std::vector<std::string>{"runs", "2", "4", "4", "4"});
  if (!has_gnuplot()) return;
  const std::string bars = slurp(scratch.path("a.svg"));
  chart.series[0].points[0] = {1, 2};
  write_svg(scratch.path("a.svg"), chart);
  CHECK(std::ranges::count(bars, 'M') > std::ranges::count(slurp(scratch.path("a.svg")), 'M'));
}

TEST_CASE("points of others are larger than ours, and marks are filled",
          "[apps][plot][.][gnuplot]") {
  const Scratch scratch;
  Chart chart{.title = "marks"};
  chart.series.push_back({"ours", {{1, 2}, {2, 3}}, Style::points});
  chart.series.push_back({"theirs", {{1, 1}}, Style::published});
  REQUIRE(write_svg(scratch.path("a.svg"), chart));
  const std::string svg = slurp(scratch.path("a.svg"));
  const auto scale = [&](std::size_t n) {  // of the n-th plot's first mark
    const std::size_t plot = svg.find("gnuplot_plot_" + std::to_string(n));
    return std::strtod(svg.c_str() + svg.find("scale(", svg.find("<use", plot)) + 6, nullptr);
  };
  CHECK(scale(2) > 1.5 * scale(1));
  const std::size_t mark = svg.find("<use xlink:href='#gpPt", svg.find("gnuplot_plot_1"));
  CHECK(svg.substr(mark, 24).find("gpPt6") != std::string::npos);  // gnuplot's mark 7: a disc
}

TEST_CASE("lines without marks differ where colours repeat", "[apps][plot][.][gnuplot]") {
  const Scratch scratch;
  Chart chart{.title = "strategies"};
  const auto has_dashes = [&] {
    REQUIRE(write_svg(scratch.path("a.svg"), chart));
    return slurp(scratch.path("a.svg")).find("stroke-dasharray") != std::string::npos;
  };
  for (int i = 0; i < 8; ++i)
    chart.series.push_back({std::to_string(i), {{0, 1.0 * i}, {1, 2.0 * i}}, Style::lines});
  CHECK_FALSE(has_dashes());
  chart.series.push_back({"8", {{0, 8}, {1, 16}}, Style::lines});
  CHECK(has_dashes());
}

TEST_CASE("the error names a path that cannot be written", "[apps][plot]") {
  const Scratch scratch;
  const std::string path = scratch.path("absent") + "/a.svg";
  CHECK_THROWS_WITH(write_svg(path, two_series()),
                    Contains("absent/a.csv: cannot be written (No such file or directory)"));
  CHECK_THROWS_WITH(write_svg(path, Timeline{}), Contains("absent/a.csv"));
  CHECK_THROWS_WITH(write_svg(scratch.path("a.png"), two_series()),
                    Contains("a.png: a picture's name must end in .svg"));
  CHECK(scratch.n_files() == 0);
}

TEST_CASE("neither a picture nor its data may be another file of the run", "[apps][plot]") {
  const Scratch scratch;
  for (const char* file : {"a.svg", "a.csv"}) {
    FileNames names;
    names.writes("--json", scratch.path(file));
    CHECK_THROWS_WITH(names.writes_picture("--plot", scratch.path("a.svg")),
                      Contains(std::string(file) + " would overwrite --json"));
    names.writes_picture("--plot", scratch.path("b.svg"));
    names.writes_picture("--plot", "");
  }
  std::filesystem::create_directory(scratch.path("c.csv"));
  CHECK_THROWS_WITH(require_picture("--plot", scratch.path("c.svg")),
                    Contains("c.csv: cannot be written: is a directory"));
  require_picture("--plot", scratch.path("d.svg"));
}

TEST_CASE("without gnuplot the data is written, but no picture", "[apps][plot]") {
  const Scratch scratch;
  const char* before = std::getenv("PATH");
  const std::string kept = before != nullptr ? before : "";
  ::setenv("PATH", scratch.path("").c_str(), 1);
  const bool drawn = write_svg(scratch.path("a.svg"), two_series());
  ::setenv("PATH", kept.c_str(), 1);
  CHECK_FALSE(drawn);
  CHECK(scratch.n_files() == 1);
  CHECK(read_csv(slurp(scratch.path("a.csv"))).size() == 6);
}

TEST_CASE("a timeline draws each bar in its row, to scale", "[apps][plot]") {
  const Scratch scratch;
  Timeline timeline{.title = wild, .rows = {"PE 0", wild}};
  timeline.bars = {{0, 1.000, 1.002, Activity::busy},
                   {0, 1.002, 1.003, Activity::idle},
                   {1, 1.000, 1.001, Activity::balancing},
                   {1, 1.001, 1.004, Activity::busy}};
  write_svg(scratch.path("t.svg"), timeline);
  const auto elements = read_xml(slurp(scratch.path("t.svg")));
  std::vector<double> widths, heights;
  for (const XmlElement& e : elements) {
    if (e.name != "rect" || e.attributes.find("fill=\"white\"") != std::string::npos) continue;
    const auto number = [&](const char* name) {
      return std::strtod(
          e.attributes.c_str() + e.attributes.find(name) + std::string(name).size() + 2, nullptr);
    };
    widths.push_back(number(" width"));
    heights.push_back(number(" y"));
  }
  REQUIRE(widths.size() == 4);
  CHECK(widths[0] == Approx(2 * widths[1]).epsilon(1e-3));
  CHECK(widths[3] == Approx(3 * widths[2]).epsilon(1e-3));
  CHECK(heights[0] == heights[1]);
  CHECK(heights[2] > heights[1]);
  CHECK(count(elements, [](const XmlElement& e) {
          return e.name == "rect" && e.attributes.find("fill=\"#0072b2\"") != std::string::npos;
        }) == 2);
  CHECK(n_texts(elements, wild) == 2);  // the title and a row
  CHECK(n_texts(elements, "ms") == 1);
  const auto lines = read_csv(slurp(scratch.path("t.csv")));
  REQUIRE(lines.size() == 5);
  CHECK(lines[4] == std::vector<std::string>{wild, "1.001", "1.004", "busy"});
}

TEST_CASE("the error names a bar that is not valid", "[apps][plot]") {
  const Scratch scratch;
  const auto message = [&](Bar bar) {
    return message_of([&] {
      write_svg(scratch.path("t.svg"), Timeline{.rows = {"PE 0"}, .bars = {{0, 0, 1}, bar}});
    });
  };
  CHECK_THAT(message({1, 0, 1}), Contains("bar 1 of the timeline: row 1 of 1"));
  CHECK_THAT(message({0, 2, 1}), Contains("from 2 to 1"));
  CHECK_THAT(message({0, 0, std::numeric_limits<double>::infinity()}), Contains("inf"));
  CHECK(scratch.n_files() == 0);
}

TEST_CASE("bytes that are not valid in XML are replaced", "[apps][plot]") {
  const std::string bad = "\xef\xbf\xbd";
  CHECK(printable("a\x01\nb\x7f") == "a  b ");
  CHECK(printable("\xc3\xa9 \xe2\x86\x92 \xf0\x9f\x9a\x80") ==
        "\xc3\xa9 \xe2\x86\x92 \xf0\x9f\x9a\x80");
  CHECK(printable("\xc3") == bad);
  CHECK(printable("\xc0\x80") == bad + bad);            // overlong
  CHECK(printable("\xed\xa0\x80") == bad + bad + bad);  // a surrogate
  CHECK(printable("\xef\xbf\xbf") == bad);              // U+FFFF
  CHECK(printable("\xf4\x90\x80\x80") == bad + bad + bad + bad);
  CHECK(xml_text("<a b=\"c\">&") == "&lt;a b=&quot;c&quot;&gt;&amp;");
  CHECK(gnuplot_string("it's") == "'it''s'");
  CHECK(csv_field("plain") == "plain");
  CHECK(csv_field("a \"b\", c\n") == "\"a \"\"b\"\", c\n\"");
}
