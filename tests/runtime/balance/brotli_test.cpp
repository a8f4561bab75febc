#include "runtime/balance/datafile/brotli.hpp"

#include "apps/bench/balance_scenes.hpp"
#include "runtime/balance/datafile/lb_datafile.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"
#include "tests/runtime/balance/memory_scenes.hpp"
#include "tests/support/catch.hpp"

#include <filesystem>
#include <fstream>

using namespace tess;
using namespace tess::balance;

namespace {

constexpr std::size_t plenty = 1U << 30U;

/// The message of the Error that unpacking gives; empty if it gives none.
std::string unpacking_says(const std::string& packed, std::size_t most_bytes = plenty) {
  try {
    (void)unpack_brotli("data.0.json.br", packed, most_bytes);
  } catch (const Error& e) {
    REQUIRE(e.code() == ErrorCode::bad_file);
    REQUIRE(std::string(e.what()).find('\n') == std::string::npos);
    REQUIRE(std::string(e.what()).starts_with("data.0.json.br: "));
    return e.what();
  }
  return "";
}

/// A directory of its own for the files of a test.
struct Scratch {
  std::filesystem::path path;
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "brotli.XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path = name;
  }
  ~Scratch() { std::filesystem::remove_all(path); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  [[nodiscard]] std::string write(const char* name, const std::string& bytes) const {
    const std::string file = (path / name).string();
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
};

std::string reading_says(const std::string& file) {
  try {
    (void)read_lb_datafiles({file});
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("text comes back from brotli as it was", "[balance][brotli]") {
  for (const std::string& text : {std::string(), std::string("a"), std::string(1'000'000, ' '),
                                  write_lb_datafile({{0, stencil(40, 4, 1)}})}) {
    const std::string packed = pack_brotli(text);
    CHECK(unpack_brotli("f", packed, text.size()) == text);
    if (text.size() > 1000) CHECK(10 * packed.size() < text.size());
  }
  std::string noise;
  Random next(1);
  for (int i = 0; i < 100'000; ++i) noise += static_cast<char>(next.below(256));
  CHECK(unpack_brotli("f", pack_brotli(noise), noise.size()) == noise);
}

TEST_CASE("brotli that is truncated, damaged or followed by more is refused by name",
          "[balance][brotli]") {
  const std::string text = write_lb_datafile({{0, stencil(6, 3, 1)}});
  const std::string packed = pack_brotli(text);
  for (std::size_t n = 0; n < packed.size(); ++n) {
    INFO(n << " of " << packed.size());
    REQUIRE_THAT(unpacking_says(packed.substr(0, n)), Catch::Contains("is truncated"));
  }
  CHECK_THAT(unpacking_says(packed + "x"), Catch::Contains("has 1 bytes after its end"));
  CHECK_THAT(unpacking_says(text), Catch::Contains("is damaged, or not compressed with brotli"));
  // The format has no checksum: what still decodes has another text.
  std::size_t n_refused = 0;
  for (std::size_t at = 0; at < packed.size(); ++at) {
    std::string damaged = packed;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    if (!unpacking_says(damaged).empty()) ++n_refused;
  }
  CHECK(4 * n_refused > packed.size());
}

TEST_CASE("text longer than its bound is refused before it is unpacked", "[balance][brotli]") {
  const std::string packed = pack_brotli(std::string(50'000'000, '0'));
  REQUIRE(packed.size() < 1000);
  CHECK_THAT(unpacking_says(packed, 1'000'000), Catch::Contains("unpack to more than 1000000"));
  CHECK_THAT(unpacking_says(packed, 49'999'999), Catch::Contains("unpack to more than"));
  CHECK(unpacking_says(packed, 50'000'000).empty());
}

TEST_CASE("a file holds the same phases compressed or not", "[balance][brotli]") {
  const Scratch scratch;
  const std::string text = write_lb_datafile({{4, any_memory(3)}, {5, stencil(9, 4, 2)}});
  const std::string plain = scratch.write("f.json", lb_datafile_bytes("f.json", text));
  const std::string packed = scratch.write("f.json.br", lb_datafile_bytes("f.json.br", text));
  CHECK(std::filesystem::file_size(plain) == text.size());
  CHECK(3 * std::filesystem::file_size(packed) < text.size());
  CHECK(write_lb_datafile(read_lb_datafiles({packed})) ==
        write_lb_datafile(read_lb_datafiles({plain})));
}

TEST_CASE("compressed files that cannot be used are refused by name", "[balance][brotli]") {
  const Scratch scratch;
  const std::string text = write_lb_datafile({{0, stencil(9, 4, 2)}});
  const std::string packed = pack_brotli(text);
  const auto said = [&](const char* name, const std::string& bytes) {
    const std::string file = scratch.write(name, bytes);
    const std::string message = reading_says(file);
    REQUIRE(message.starts_with(file + ": "));
    REQUIRE(message.find('\n') == std::string::npos);
    return message;
  };
  CHECK_THAT(said("cut.json.br", packed.substr(0, packed.size() / 2)),
             Catch::Contains("is truncated"));
  CHECK_THAT(said("plain.json.br", text), Catch::Contains("not compressed with brotli"));
  CHECK_THAT(said("packed.json", packed), Catch::Contains("let its name end in .br"));
  CHECK_THAT(said("bomb.json.br", pack_brotli(std::string(70'000'000, ' '))),
             Catch::Contains("unpack to more than 67108864"));
  CHECK_THAT(said("empty.json.br", ""), Catch::Contains("cannot be read, or is empty"));
  // One flipped bit anywhere: refused by name, or another text that the format allows.
  for (std::size_t at = 0; at < packed.size(); at += 7) {
    std::string damaged = packed;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    const std::string file = scratch.write("damaged.json.br", damaged);
    const std::string message = reading_says(file);
    if (!message.empty()) REQUIRE(message.find('\n') == std::string::npos);
  }
}
