#include "apps/m2m_transfer/drive_files.hpp"

#include "apps/kit/write_file.hpp"
#include "apps/m2m_transfer/file_fields.hpp"

namespace m2m_transfer {
namespace {

FileFieldsRequest request_of(const DriverOptions& options) {
  const Request& r = options.request;
  return {r.source,
          r.target,
          r.fields,
          options.step,
          options.weights,
          options.from_weights,
          options.out,
          options.policies.front(),
          r.kind,
          r.partition,
          r.n_chares != 0 ? r.n_chares : r.per_pe * machine().n_pes(),
          r.voxel,
          r.tolerance,
          r.clamp};
}

}  // namespace

bool moves_file_fields(const DriverOptions& options) {
  return is_for_files(request_of(options));
}

Task move_file_fields(const DriverOptions& options, kit::Progress& progress) {
  kit::require_writable("--json", options.json);
  const FileFieldsRequest request = request_of(options);
  const FileFieldsReport report = co_await move_file_fields(request, progress);
  if (!options.json.empty()) kit::write_file(options.json, json(report));
  progress.clear();
  print(table(report));
}

}  // namespace m2m_transfer
