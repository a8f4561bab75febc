#include "m2m/io/ranges/mesh_ranges.hpp"

#include "m2m/io/file_bytes.hpp"
#include "m2m/io/ranges/exodus_ranges.hpp"
#include "m2m/io/ranges/gmsh_ranges.hpp"
#include "m2m/kuhn.hpp"
#include "runtime/core/error.hpp"

namespace tess::m2m {
namespace {

class KuhnRanges final : public MeshRanges {
 public:
  explicit KuhnRanges(KuhnBox box) : box_(box) {
    n_points = m2m::n_points(box);
    n_tets = m2m::n_tets(box);
  }
  void points(GlobalId first, std::span<Point> out) override { kuhn_points(box_, first, out); }
  void tets(GlobalId first, std::span<Tet> out) override { kuhn_tets(box_, first, out); }

 private:
  KuhnBox box_;
};

}  // namespace

std::unique_ptr<MeshRanges> open_ranges(const std::string& name, RangeCheck check) {
  if (name.starts_with("kuhn:")) return std::make_unique<KuhnRanges>(parse_kuhn(name));
  try {
    const FileBytes file(name);
    if (file.view().starts_with("$")) return open_gmsh_ranges(name, check);
    if (file.view().starts_with("CDF")) return open_exodus_ranges(name, file.view());
  } catch (const Error&) {
    return nullptr;  // read_mesh() gives the reason
  }
  return nullptr;
}

}  // namespace tess::m2m
