#include "runtime/checkpoint/manifest.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace tess::detail {
namespace {

using Json = nlohmann::ordered_json;

std::string hex(std::uint64_t value) {
  return fmt::format("{:016x}", value);
}
std::uint64_t from_hex(const Json& value) {
  return std::stoull(value.get<std::string>(), nullptr, 16);
}
std::string hash_of(const Json& json) {
  const std::string text = json.dump();
  return hex(hash_bytes(text.data(), text.size()));
}

Manifest parse(const std::string& path, const std::string& text) {
  Json json = Json::parse(text);
  const std::string hash = json.at("hash").get<std::string>();
  json.erase("hash");
  if (const auto version = json.at("tessera_checkpoint").get<std::uint32_t>();
      version != checkpoint_version)
    fail(ErrorCode::bad_file, path, " has version ", version, ", but this program reads ",
         checkpoint_version);
  if (hash != hash_of(json))
    fail(ErrorCode::bad_file, path, " is damaged: it is not as its checksum says");
  Manifest manifest;
  manifest.number = json.at("number").get<std::uint64_t>();
  manifest.n_pes = json.at("pes").get<std::int32_t>();
  manifest.n_processes = json.at("processes").get<std::int32_t>();
  manifest.program = from_hex(json.at("program"));
  for (const Json& run : json.at("runs")) manifest.lineage.push_back(from_hex(run));
  manifest.note = json.at("note").get<std::string>();
  manifest.buddy_copies = json.at("buddy_copies").get<bool>();
  for (const Json& file : json.at("files"))
    manifest.files.push_back({file.at("name").get<std::string>(),
                              file.at("bytes").get<std::uint64_t>(), from_hex(file.at("hash"))});
  if (manifest.n_pes < 1 || manifest.files.size() != static_cast<std::size_t>(manifest.n_pes) + 1)
    fail(ErrorCode::bad_file, path, " lists ", manifest.files.size(), " files for ", manifest.n_pes,
         " PEs");
  if (manifest.lineage.empty()) fail(ErrorCode::bad_file, path, " does not say which run wrote it");
  return manifest;
}

}  // namespace

void check_note(const std::string& note) {
  try {
    (void)Json(note).dump();
  } catch (const Json::exception&) {
    fail(ErrorCode::bad_argument, "the note of a checkpoint is no text in UTF-8: ", note);
  }
}

std::string to_text(const Manifest& manifest, const MainPart& main) {
  Json json;
  json["tessera_checkpoint"] = checkpoint_version;
  json["number"] = manifest.number;
  json["pes"] = manifest.n_pes;
  json["processes"] = manifest.n_processes;
  json["program"] = hex(manifest.program);
  json["runs"] = Json::array();
  for (const std::uint64_t run : manifest.lineage) json["runs"].push_back(hex(run));
  json["note"] = manifest.note;
  json["buddy_copies"] = manifest.buddy_copies;
  json["collections"] = Json::array();
  for (const SavedCollection& one : main.collections)
    json["collections"].push_back({{"class", one.name}, {"elements", one.n_elements}});
  json["files"] = Json::array();
  for (const FileSum& file : manifest.files)
    json["files"].push_back(
        {{"name", file.name}, {"bytes", file.n_bytes}, {"hash", hex(file.hash)}});
  json["hash"] = hash_of(json);
  return json.dump(2) + "\n";
}

void write_manifest(const std::string& folder, const std::string& text) {
  write_last(folder, "manifest.json", text);
}

Manifest read_manifest(const std::string& folder) {
  const std::string path = folder + "/manifest.json";
  if (!has_file(folder, "manifest.json"))
    fail(ErrorCode::bad_file, path, " is missing: the checkpoint was not finished");
  const std::string text = read_text(folder, "manifest.json");
  try {
    return parse(path, text);
  } catch (const Error&) {
    throw;
  } catch (const std::exception&) {
    fail(ErrorCode::bad_file, path, " is damaged: it cannot be read as a manifest");
  }
}

}  // namespace tess::detail
