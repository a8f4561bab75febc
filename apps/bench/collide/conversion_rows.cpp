#include "apps/bench/collide/conversion.hpp"
#include "apps/bench/collide/one_core.hpp"
#include "apps/bench/collide/rows.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/hash.hpp"

#include <fmt/core.h>

namespace bench {

RowTexts conversion_row_texts() {
  RowTexts rows;
  for (const Conversion& conversion : conversions()) {
    const std::string name = fmt::format("conversion_{}", conversion.name);
    rows.emplace_back(name, fmt::format("ns per coordinate: {}", conversion.meaning));
    rows.emplace_back(name + "_wrong_faces", "share of wrong indices on faces of voxels");
    rows.emplace_back(name + "_wrong_negatives", "share of wrong indices below the origin");
    rows.emplace_back(name + "_wrong_out_of_range",
                      "share that is neither refused nor clamped beyond the last index");
  }
  return rows;
}

void conversion_rows(Output& output) {
  constexpr std::size_t n_boxes = 512, n = 6 * n_boxes;  // stays in the first cache
  std::vector<tess::collide::Aabb> boxes(n_boxes);
  tess::Random random(2);
  for (auto& box : boxes)
    for (std::size_t k = 0; k < 3; ++k) {
      box.lo[k] = 1000 * random.unit() - 500;
      box.hi[k] = box.lo[k] + random.unit();
    }
  std::vector<std::int32_t> index(n);
  std::vector<Samples> times(conversions().size());
  const int rounds = output.options().quick ? 100 : 10'000;
  for (int i = 0; i <= output.options().repeat; ++i)
    for (std::size_t c = 0; c < conversions().size(); ++c) {
      const ProcessWatch watch;
      for (int round = 0; round < rounds; ++round) {
        TESS_CHECK(conversions()[c].run({0, 0.25}, boxes, index.data()), "a coordinate is refused");
        asm volatile("" : : "r"(index.data()) : "memory");
      }
      if (i > 0) times[c].add(watch.nanoseconds() / (static_cast<double>(rounds) * n));
    }
  for (std::size_t c = 0; c < conversions().size(); ++c) {
    const Conversion& conversion = conversions()[c];
    const std::string name = fmt::format("conversion_{}", conversion.name);
    output.row("conversion", name, times[c], "ns");
    const auto wrong = [&](const char* kind, const ConversionErrors& errors) {
      output.row("conversion", fmt::format("{}_wrong_{}", name, kind),
                 100 * static_cast<double>(errors.n_wrong) / static_cast<double>(errors.n), "%");
    };
    wrong("faces", errors_on_faces(conversion));
    wrong("negatives", errors_of_negatives(conversion));
    wrong("out_of_range", errors_out_of_range(conversion));
  }
}

}  // namespace bench
