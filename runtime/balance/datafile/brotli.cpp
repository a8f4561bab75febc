#include "runtime/balance/datafile/brotli.hpp"

#include "runtime/core/error.hpp"

#include <brotli/decode.h>
#include <brotli/encode.h>
#include <cstdint>
#include <memory>

namespace tess::balance {
namespace {

// Of 9.5 MB of JSON a thirty-third remains after 0.07 s; at 11, the default, a forty-first after 17
// s.
constexpr int quality = 5;

const std::uint8_t* bytes_of(std::string_view text) {
  return reinterpret_cast<const std::uint8_t*>(text.data());
}

struct Destroy {
  void operator()(BrotliDecoderState* decoder) const { BrotliDecoderDestroyInstance(decoder); }
};

}  // namespace

std::string pack_brotli(std::string_view text) {
  std::size_t n = BrotliEncoderMaxCompressedSize(text.size());
  std::string packed(n, '\0');
  if (n == 0 || BrotliEncoderCompress(
                    quality, BROTLI_DEFAULT_WINDOW, BROTLI_MODE_TEXT, text.size(), bytes_of(text),
                    &n, reinterpret_cast<std::uint8_t*>(packed.data())) == BROTLI_FALSE)
    fail(ErrorCode::environment, "BrotliEncoderCompress fails for ", text.size(), " bytes");
  packed.resize(n);
  return packed;
}

std::string unpack_brotli(const std::string& file, std::string_view packed,
                          std::size_t most_bytes) {
  const std::unique_ptr<BrotliDecoderState, Destroy> decoder(
      BrotliDecoderCreateInstance(nullptr, nullptr, nullptr));
  if (!decoder) fail(ErrorCode::environment, "BrotliDecoderCreateInstance fails: no memory");
  std::string text;
  std::size_t n_left = packed.size();
  const std::uint8_t* next = bytes_of(packed);
  for (;;) {
    std::size_t none = 0;  // the decoder keeps its output until it is taken
    const BrotliDecoderResult result =
        BrotliDecoderDecompressStream(decoder.get(), &n_left, &next, &none, nullptr, nullptr);
    while (BrotliDecoderHasMoreOutput(decoder.get()) != BROTLI_FALSE) {
      std::size_t n = 0;
      const std::uint8_t* piece = BrotliDecoderTakeOutput(decoder.get(), &n);
      if (n > most_bytes - text.size())
        fail(ErrorCode::bad_file, file, ": its ", packed.size(), " bytes unpack to more than ",
             most_bytes,
             ", which a file of this size is not expected to; unpack it by hand "
             "(brotli -d) if it is right");
      text.append(reinterpret_cast<const char*>(piece), n);
    }
    if (result == BROTLI_DECODER_RESULT_SUCCESS) break;
    if (result == BROTLI_DECODER_RESULT_NEEDS_MORE_INPUT)
      fail(ErrorCode::bad_file, file, ": is truncated: its ", packed.size(),
           " bytes of brotli end within the text; write it again");
    if (result == BROTLI_DECODER_RESULT_ERROR)
      fail(ErrorCode::bad_file, file, ": is damaged, or not compressed with brotli, before byte ",
           packed.size() - n_left, " of ", packed.size(), "; write it again");
  }
  if (n_left > 0)
    fail(ErrorCode::bad_file, file, ": has ", n_left, " bytes after its end; write it again");
  return text;
}

}  // namespace tess::balance
