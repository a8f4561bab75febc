// Chooses the division of each block: the coarsest for which every voxel, decoded as samples are,
// meets the bound.
#include "collide/dn_field/field/compressed_sample.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <optional>
#include <unordered_map>

namespace tess::dn {
namespace {
constexpr int min_shift = 2, max_shift = 4;
constexpr int min_normal_bits = 4, max_normal_bits = 11;
constexpr double entry_share = 0.4;  // of the angle's bound that writing an entry may take

/// Between the normals of an entry and of a voxel, which has one. An entry without a normal fits
/// none: it is made where normals cancel out, as on both sides of a thin plate.
double angle_between(Vec3 entry, Vec3 voxel) {
  if (entry == Vec3{}) return HUGE_VAL;
  return std::atan2(norm(cross(entry, voxel)), dot(entry, voxel));
}

/// The distances at a cell's middle that keep all its voxels on their side of the cut-off.
struct Allowed {
  double least = -HUGE_VAL, most = HUGE_VAL;
};

struct Plane {
  float distance;  // at the cell's middle
  Normal normal;   // unit, or zero
};

Vec3 to_vec3(const Normal& n) {
  return {static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z)};
}

/// The distance of a voxel with its centre at (x, y, z) from the cell's middle.
float distance_to(const Plane& plane, float x, float y, float z, float cut_off) {
  const float d = plane.distance + (plane.normal.x * x + plane.normal.y * y + plane.normal.z * z);
  const float above = d > -cut_off ? d : -cut_off;
  return above < cut_off ? above : cut_off;
}

/// Of the distances of entries: the middle of a cell may be a block's diagonal beyond the cut-off.
double furthest_middle(const Field& field, int shift) {
  return field.thickness + field.grid.cell * (2 << shift);
}

class Compressor {
 public:
  Compressor(const Field& field, const ErrorBound& bound, const EntryLayout& layout, int shift)
      : field_(field),
        bound_(bound),
        layout_(layout),
        shift_(shift),
        cell_(static_cast<float>(field.grid.cell)),
        thickness_(static_cast<float>(field.thickness)),
        cut_off_(cut_off(field.thickness)),
        rounding_(8 * 0x1p-24 * furthest_middle(field, shift)) {}

  /// Empty if entries do not meet the bound even voxel by voxel.
  [[nodiscard]] std::optional<Planes> run();

 private:
  struct Voxel {
    double distance;
    Vec3 normal;    // zero: has none
    float x, y, z;  // from the cell's middle
    [[nodiscard]] double along(Vec3 n) const {
      return dot(n, {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
    }
  };

  void gather(std::array<int, 3> low, int s);
  /// Whether a voxel is at the cut-off.
  [[nodiscard]] bool is_far(const Voxel& v) const {
    return v.normal == Vec3{} && std::abs(v.distance) >= static_cast<double>(thickness_);
  }
  [[nodiscard]] std::uint32_t written(double distance, Vec3 normal,
                                      const Allowed& range = {}) const;
  [[nodiscard]] Plane plane(std::uint32_t entry) const {
    const lanes::Stored all = lanes::decode(layout_, lanes::I{} + static_cast<std::int32_t>(entry));
    return {all.distance[0], {all.normal.x[0], all.normal.y[0], all.normal.z[0]}};
  }
  [[nodiscard]] std::uint32_t written_normal(Vec3 normal) const;
  [[nodiscard]] Allowed allowed(Vec3 normal) const;
  [[nodiscard]] double fitted_distance(Vec3 normal, const Allowed& range) const;
  [[nodiscard]] bool fits(std::array<int, 3> low, int s, std::uint32_t& entry);
  [[nodiscard]] bool divide(std::array<int, 3> low, int s, std::vector<std::uint32_t>& entries);

  const Field& field_;
  ErrorBound bound_, off_{}, measured_{};
  EntryLayout layout_;
  int shift_;
  float cell_, thickness_, cut_off_;
  double rounding_;  // of a voxel's distance
  std::vector<Voxel> voxels_;
};

void Compressor::gather(std::array<int, 3> low, int s) {
  const Grid& grid = field_.grid;
  const int edge = 1 << s, in_cell = edge - 1;
  const float half = 0.5F * cell_;
  voxels_.clear();
  for (int k = low[2]; k < std::min(low[2] + edge, grid.n[2]); ++k)
    for (int j = low[1]; j < std::min(low[1] + edge, grid.n[1]); ++j)
      for (int i = low[0]; i < std::min(low[0] + edge, grid.n[0]); ++i) {
        const std::size_t at = grid.index(i, j, k);
        voxels_.push_back({static_cast<double>(field_.distance[at]),
                           to_vec3(decode_normal(field_.normal[at])),
                           half * static_cast<float>(2 * (i - low[0]) - in_cell),
                           half * static_cast<float>(2 * (j - low[1]) - in_cell),
                           half * static_cast<float>(2 * (k - low[2]) - in_cell)});
      }
}

std::uint32_t Compressor::written(double distance, Vec3 normal, const Allowed& range) const {
  const auto most = static_cast<double>(layout_.zero() - 1),
             step = static_cast<double>(layout_.step);
  double steps = step > 0 ? std::round(distance / step) : 0;
  if (steps * step > range.most) steps = std::floor(range.most / step);
  if (steps * step < range.least) steps = std::ceil(range.least / step);
  const auto above =
      static_cast<std::uint32_t>(static_cast<int>(std::clamp(steps, -most, most)) + layout_.zero());
  return above << (2 * layout_.normal_bits) | written_normal(normal);
}

/// The two coordinates on the octahedral map that decode closest to `normal`: one of four
/// neighbours.
std::uint32_t Compressor::written_normal(Vec3 normal) const {
  if (normal == Vec3{}) return static_cast<std::uint32_t>(layout_.mask() << layout_.normal_bits);
  const auto [u, v] = on_octahedral_map(normal);
  const auto low = [&](double t) {
    return std::clamp(static_cast<int>(std::floor((t + 1) * layout_.middle())), 0,
                      2 * layout_.middle() - 1);
  };
  lanes::I words{};
  for (int corner = 0; corner < 4; ++corner)
    words[corner] = (low(u) + (corner & 1)) << layout_.normal_bits | (low(v) + (corner >> 1));
  const lanes::F3 decoded = lanes::decode(layout_, words).normal;
  std::uint32_t best = 0;
  double closest = -2;
  for (int corner = 0; corner < 4; ++corner) {
    const double agree = dot(lanes::lane(decoded, corner), normal);
    if (agree > closest) closest = agree, best = static_cast<std::uint32_t>(words[corner]);
  }
  return best;
}

/// Voxels at the cut-off stay there: otherwise a rule that reaches as far as the field would act in
/// them. The others keep their normals, which voxels at the cut-off have not.
Allowed Compressor::allowed(Vec3 normal) const {
  const double far = static_cast<double>(cut_off_) + rounding_,
               near = static_cast<double>(cut_off_) - rounding_;
  Allowed range;
  for (const Voxel& v : voxels_) {
    const double along = v.along(normal);
    if (is_far(v) && v.distance > 0) {
      range.least = std::max(range.least, far - along);
    } else if (is_far(v)) {
      range.most = std::min(range.most, -far - along);
    } else if (v.normal != Vec3{}) {
      range.least = std::max(range.least, -near - along);
      range.most = std::min(range.most, near - along);
    }
  }
  return range;
}

/// The distance at the middle that is least off.
double Compressor::fitted_distance(Vec3 normal, const Allowed& range) const {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Voxel& v : voxels_) {
    if (is_far(v)) continue;
    low = std::min(low, v.distance - v.along(normal));
    high = std::max(high, v.distance - v.along(normal));
  }
  const double middle = low > high ? 0 : 0.5 * (low + high);
  return std::max(std::min(middle, range.most), range.least);
}

bool Compressor::fits(std::array<int, 3> low, int s, std::uint32_t& entry) {
  gather(low, s);
  off_ = {};
  if (voxels_.empty()) {  // beyond the grid
    entry = 0;
    return true;
  }
  Vec3 sum;
  for (const Voxel& v : voxels_) sum += v.normal;
  const Vec3 normal = direction(sum), kept = to_vec3(plane(written(0, normal)).normal);
  const Allowed range = allowed(kept);
  if (!(range.least <= range.most)) return false;
  entry = written(fitted_distance(kept, range), normal, range);
  const Plane made = plane(entry);
  const Vec3 made_normal = to_vec3(made.normal);
  for (const Voxel& v : voxels_) {
    const auto d = static_cast<double>(distance_to(made, v.x, v.y, v.z, cut_off_));
    const bool is_cut_off = std::abs(d) >= static_cast<double>(cut_off_);
    if (is_far(v) ? !is_cut_off : is_cut_off && v.normal != Vec3{}) return false;
    const double off = std::abs(d - v.distance);
    if (!(off <= bound_.distance)) return false;  // also NaN
    off_.distance = std::max(off_.distance, off);
    if (v.normal != Vec3{}) off_.angle = std::max(off_.angle, angle_between(made_normal, v.normal));
    if (!(off_.angle <= bound_.angle)) return false;
  }
  return true;
}

bool Compressor::divide(std::array<int, 3> low, int s, std::vector<std::uint32_t>& entries) {
  ErrorBound worst;
  entries.clear();
  const int edge = 1 << s, block = 1 << shift_;
  for (int k = 0; k < block; k += edge)
    for (int j = 0; j < block; j += edge)
      for (int i = 0; i < block; i += edge) {
        std::uint32_t entry = 0;
        if (!fits({low[0] + i, low[1] + j, low[2] + k}, s, entry)) return false;
        entries.push_back(entry);
        worst = {std::max(worst.distance, off_.distance), std::max(worst.angle, off_.angle)};
      }
  measured_ = {std::max(measured_.distance, worst.distance),
               std::max(measured_.angle, worst.angle)};
  return true;
}

std::optional<Planes> Compressor::run() {
  const Grid& grid = field_.grid;
  Planes made{shift_, {}, layout_, {}, {}, bound_, {}};
  const int block = 1 << shift_;
  for (std::size_t a = 0; a < 3; ++a) made.n_blocks[a] = (grid.n[a] + block - 1) / block;
  std::unordered_map<std::uint32_t, std::uint32_t> undivided;  // blocks that are alike share one
  std::vector<std::uint32_t> entries;
  for (int k = 0; k < grid.n[2]; k += block)
    for (int j = 0; j < grid.n[1]; j += block)
      for (int i = 0; i < grid.n[0]; i += block) {
        int s = shift_;
        while (s >= 0 && !divide({i, j, k}, s, entries)) --s;
        if (s < 0) return std::nullopt;
        const auto n_entries = static_cast<std::uint32_t>(made.entry.size());
        const std::uint32_t first =
            s == shift_ ? undivided.try_emplace(entries[0], n_entries).first->second : n_entries;
        made.block.push_back(first << 3U | static_cast<std::uint32_t>(s));
        if (first != n_entries) continue;
        made.entry.insert(made.entry.end(), entries.begin(), entries.end());
        if (made.entry.size() >= (1U << 28U))
          fail(ErrorCode::bad_argument, "more than 2^28 entries in a compressed field of ",
               grid.n[0], " × ", grid.n[1], " × ", grid.n[2],
               " voxels; raise the error bound or lower the resolution");
      }
  made.measured = measured_;
  return made;
}

lanes::Voxel one_voxel(int i, int j, int k) {
  const lanes::I zero{};
  return {~zero, zero + i, zero + j, zero + k};
}

EntryLayout layout_for(const Field& field, const ErrorBound& bound, int shift) {
  // A normal of so many bits an axis is off by at most 3 / 2^bits, with the best of four neighbours
  // on the octahedral map; that it is, is checked voxel by voxel.
  int bits = min_normal_bits;
  while (bits < max_normal_bits && 3.0 / (1 << bits) > entry_share * bound.angle) ++bits;
  const double steps = std::ldexp(1.0, 31 - 2 * bits) - 1;
  return {bits, static_cast<float>(furthest_middle(field, shift) / steps)};
}

}  // namespace

Field compress(const Field& field, const ErrorBound& bound, int block_shift) {
  if (!(bound.distance >= 0) || !(bound.angle >= 0))
    fail(ErrorCode::bad_argument, "error bound of distance ", bound.distance, " and angle ",
         bound.angle, "; neither may be negative or NaN");
  if (block_shift != 0 && (block_shift < min_shift || block_shift > max_shift))
    fail(ErrorCode::bad_argument, "blocks of 2^", block_shift, " voxels; the exponent must be ",
         min_shift, " to ", max_shift, ", or 0 for the best");
  if (field.planes != nullptr)
    fail(ErrorCode::bad_argument, "the field is compressed already; compress the flat one");
  if (field.normal.empty())
    fail(ErrorCode::bad_argument,
         "a field without normals cannot be compressed; build it with them");
  std::optional<Planes> best;
  const int first = block_shift == 0 ? min_shift : block_shift;
  const int last = block_shift == 0 ? max_shift : block_shift;
  for (int shift = first; shift <= last; ++shift) {
    auto made = Compressor(field, bound, layout_for(field, bound, shift), shift).run();
    if (best && made && made->bytes() >= best->bytes()) break;
    if (made) best = std::move(made);
  }
  if (!best)
    fail(ErrorCode::bad_argument, "error bound of distance ", bound.distance, " and angle ",
         bound.angle, ": entries of 32 bits do not meet it within a thickness of ", field.thickness,
         "; raise it, or keep the field flat");
  return {field.grid,
          field.method,
          field.sides,
          field.thickness,
          {},
          {},
          field.jump,
          field.surface,
          std::make_shared<const Planes>(std::move(*best))};
}

float voxel_distance(const Field& field, int i, int j, int k) {
  if (field.planes == nullptr) return field.distance[field.grid.index(i, j, k)];
  return lanes::planes_at(plane_sampler_of(field), one_voxel(i, j, k)).distance[0];
}

Vec3 voxel_normal(const Field& field, int i, int j, int k) {
  const lanes::Stored stored =
      field.planes == nullptr
          ? lanes::read<LookUp::nearest, Ask::both>(sampler_of(field), one_voxel(i, j, k))
          : lanes::planes_at(plane_sampler_of(field), one_voxel(i, j, k));
  return lanes::lane(stored.normal, 0);
}

}  // namespace tess::dn
