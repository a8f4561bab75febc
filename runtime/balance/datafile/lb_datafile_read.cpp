#include "runtime/balance/datafile/lb_datafile.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

namespace tess::balance {
namespace {

using nlohmann::json;

/// No machine has more PEs: a higher node number means a damaged file, not a demand for memory.
constexpr std::uint64_t most_pes = 1U << 20U;

/// A value and its place in the file; every access reports errors with the place.
class Place {
 public:
  Place(const json& value, std::string where) : value_(value), where_(std::move(where)) {}

  [[nodiscard]] bool has(const char* key) const {
    return value_.is_object() && value_.contains(key);
  }
  [[nodiscard]] Place operator[](const char* key) const {
    if (!value_.is_object()) damaged("is not an object");
    const auto found = value_.find(key);
    if (found == value_.end()) damaged(text("lacks '", key, "'"));
    return {*found, where_ + ' ' + key};
  }
  [[nodiscard]] std::size_t size() const {
    if (!value_.is_array()) damaged("is not an array");
    return value_.size();
  }
  [[nodiscard]] Place at(std::size_t k) const { return {value_[k], text(where_, ' ', k)}; }

  [[nodiscard]] std::string word() const {
    if (!value_.is_string()) damaged("is not a string");
    return value_.get<std::string>();
  }
  [[nodiscard]] bool truth() const {
    if (!value_.is_boolean()) damaged("is not true or false");
    return value_.get<bool>();
  }
  [[nodiscard]] bool is_count() const { return value_.is_number_unsigned(); }
  [[nodiscard]] std::uint64_t count() const {
    if (!is_count()) damaged("is not a whole number from 0 on");
    return value_.get<std::uint64_t>();
  }
  [[nodiscard]] double number() const {
    if (!value_.is_number() || !std::isfinite(value_.get<double>())) damaged("is not a number");
    return value_.get<double>();
  }
  [[nodiscard]] double amount() const {
    const double result = number();
    if (result < 0) damaged("is below 0");
    return result;
  }
  /// A count that other programs write as a floating-point number.
  [[nodiscard]] std::uint64_t whole_amount() const {
    if (is_count()) return count();
    if (amount() >= 0x1p63) damaged("is above 2^63");
    return static_cast<std::uint64_t>(amount());
  }
  /// The same, or no value below 0.
  [[nodiscard]] std::optional<std::uint64_t> whole_or_none() const {
    if (number() < 0) return std::nullopt;
    if (std::floor(number()) != number()) damaged("is not a whole number");
    return whole_amount();
  }

  [[nodiscard]] std::string dump() const { return value_.dump(); }
  [[nodiscard]] const std::string& where() const { return where_; }

  [[noreturn]] void damaged(const std::string& what) const {
    fail(ErrorCode::bad_file, where_, ' ', what,
         ", which the LBDatafile schema does not allow; write the file again");
  }

 private:
  const json& value_;
  std::string where_;
};

/// The name of an entity in a file: an id is unique, a sequence number often only together with its
/// home, which a file need not give.
using Name = std::tuple<bool, std::uint64_t, std::uint64_t>;
constexpr std::uint64_t no_home = std::numeric_limits<std::uint64_t>::max();

Name name_of(const Place& entity) {
  if (entity.has("id")) return {true, entity["id"].count(), 0};
  if (!entity.has("seq_id")) entity.damaged("lacks 'id' or 'seq_id'");
  return {false, entity["seq_id"].count(), entity.has("home") ? entity["home"].count() : no_home};
}

ElementKey key_of(const Place& entity) {
  ElementKey key;
  if (entity.has("collection_id")) {
    key.array.value = entity["collection_id"].count();
    if (entity.has("index") && entity["index"].size() == 1 && entity["index"].at(0).is_count()) {
      key.element = entity["index"].at(0).count();
      return key;
    }
  }
  key.element = std::get<1>(name_of(entity));
  return key;
}

/// One phase, gathered from all files.
class Gathering {
 public:
  void add_tasks(const Place& phase) {
    const Place tasks = phase["tasks"];
    for (std::size_t k = 0; k < tasks.size(); ++k) add_task(tasks.at(k));
    if (phase.has("user_defined") && phase["user_defined"].has("pe_speed"))
      read_pes(phase["user_defined"]);
  }

  void add_communications(const Place& phase) {
    if (!phase.has("communications")) return;
    const Place all = phase["communications"];
    for (std::size_t k = 0; k < all.size(); ++k) {
      const Place one = all.at(k);
      if (one["type"].word() != "SendRecv") {  // from or to all of a collection, or of a node
        ++n_left_out_;
        continue;
      }
      const auto from = element(one["from"]), to = element(one["to"]);
      const Edge edge{from.value_or(0), to.value_or(0), one["bytes"].whole_amount(),
                      one["messages"].count()};
      if (from && to)
        s_.edges.push_back(edge);
      else
        ++n_left_out_;
    }
  }

  [[nodiscard]] std::size_t n_left_out() const { return n_left_out_; }
  [[nodiscard]] std::size_t n_pes() const { return std::max(s_.pes.size(), highest_ + 1); }

  /// With `n_pes` PEs if no file describes them.
  [[nodiscard]] Snapshot finish(std::size_t n_pes) {
    auto& e = s_.elements;
    if (n_positions_ != e.size()) e.position.clear();
    if (std::ranges::count(e.index, "") > 0) e.index.clear();
    if (s_.blocks.empty()) e.block.clear();
    if (std::ranges::count(e.working_bytes, 0U) == std::ssize(e.working_bytes))
      e.working_bytes.clear();
    if (s_.pes.size() == 0) {
      s_.pes.speed.assign(n_pes, 1.0);
      s_.pes.background.assign(n_pes, 0.0);
      s_.pes.memory_limit_bytes.assign(n_pes, 0);
    }
    if (highest_ >= s_.pes.size())
      fail(ErrorCode::bad_file, highest_where_, " is PE ", highest_, " of ", s_.pes.size(),
           " PEs, which pe_speed lists; write the file again");
    for (const auto& [node, bytes] : rank_working_bytes_) {
      if (bytes == 0 || node >= s_.pes.size()) continue;
      s_.pes.working_bytes.resize(s_.pes.size(), 0);
      s_.pes.working_bytes[node] = std::max(s_.pes.working_bytes[node], bytes);
    }
    validate(s_);
    return std::move(s_);
  }

 private:
  void add_task(const Place& task) {
    const Place entity = task["entity"];
    const std::uint64_t node = task["node"].count();
    if (node >= most_pes) task["node"].damaged(text("is ", node, ", not below ", most_pes));
    const double time = task["time"].amount();
    if (entity["type"].word() != "object") return;
    const bool is_new = positions_.try_emplace(name_of(entity), s_.elements.size()).second;
    if (!is_new && time == 0) return;  // vt marks a rank without work so, equally in all files
    if (!is_new) entity.damaged("is there twice");
    auto& e = s_.elements;
    note_pe(node, task["node"]);
    e.key.push_back(key_of(entity));
    e.index.push_back(entity.has("index") ? entity["index"].dump() : "");
    e.pe.push_back(pe_at(node));
    e.load.push_back(time);
    e.migratable.push_back(entity["migratable"].truth());
    e.size_bytes.push_back(0);
    e.memory_bytes.push_back(0);
    e.position.push_back({});
    e.working_bytes.push_back(0);
    e.block.push_back(no_block);
    if (task.has("user_defined")) read_extras(task["user_defined"], node);
  }

  void read_extras(const Place& user, std::uint64_t node) {
    auto& e = s_.elements;
    const auto take = [&](const char* key, std::uint64_t& bytes) {
      if (user.has(key)) bytes = user[key].whole_amount();
    };
    take("size_bytes", e.size_bytes.back());  // files written before vt's names were used
    take("memory_bytes", e.memory_bytes.back());
    take("task_serialized_bytes", e.size_bytes.back());
    take("task_footprint_bytes", e.memory_bytes.back());
    take("task_working_bytes", e.working_bytes.back());
    std::uint64_t rank_bytes = 0;
    take("rank_working_bytes", rank_bytes);
    rank_working_bytes_[node] = std::max(rank_working_bytes_[node], rank_bytes);
    if (user.has("shared_id")) read_block(user, node);
    if (user.has("measured") && user["measured"].whole_amount() == 0)
      e.load.back() = Load::unknown();
    if (!user.has("position_x")) return;
    e.position.back() = {user["position_x"].number(), user["position_y"].number(),
                         user["position_z"].number()};
    ++n_positions_;
  }

  void note_pe(std::uint64_t pe, const Place& from) {
    if (pe <= highest_ && !highest_where_.empty()) return;
    highest_ = static_cast<std::size_t>(pe);
    highest_where_ = from.where();
  }

  void read_block(const Place& user, std::uint64_t node) {
    const auto id = user["shared_id"].whole_or_none();
    if (!id) return;
    const auto [at, is_new] = blocks_.try_emplace(*id, s_.blocks.size());
    if (is_new) {
      const auto home = user.has("home_rank") ? user["home_rank"].whole_or_none() : node;
      if (home && *home >= most_pes)
        user["home_rank"].damaged(text("is ", *home, ", not below ", most_pes));
      s_.blocks.push_back({*id, 0, pe_at(home.value_or(node))});
      note_pe(home.value_or(node), user);
    }
    auto& bytes = s_.blocks[at->second].bytes;
    bytes = std::max(bytes, user["shared_bytes"].whole_amount());
    s_.elements.block.back() = at->second;
  }

  void read_pes(const Place& user) {
    const Place speed = user["pe_speed"];
    const Place background = user["pe_background"];
    const Place limit = user["pe_memory_limit_bytes"];
    if (background.size() != speed.size() || limit.size() != speed.size())
      user.damaged("has lists of PEs that differ in length");
    s_.pes = {};
    for (std::size_t p = 0; p < speed.size(); ++p) {
      if (!(speed.at(p).number() > 0)) speed.at(p).damaged("is not above 0");
      s_.pes.speed.push_back(speed.at(p).number());
      s_.pes.background.push_back(background.at(p).amount());
      s_.pes.memory_limit_bytes.push_back(limit.at(p).count());
    }
    if (!user.has("pe_working_bytes")) return;
    const Place working = user["pe_working_bytes"];
    if (working.size() != speed.size()) user.damaged("has lists of PEs that differ in length");
    for (std::size_t p = 0; p < working.size(); ++p)
      s_.pes.working_bytes.push_back(working.at(p).whole_amount());
  }

  /// None if no task in the files has the name: the schema allows such messages.
  [[nodiscard]] std::optional<std::size_t> element(const Place& entity) const {
    const Name name = name_of(entity);
    if (const auto found = positions_.find(name); found != positions_.end()) return found->second;
    const auto [is_id, number, home] = name;
    if (is_id) return std::nullopt;
    // Without a home on either side, a sequence number that is unique names its task.
    std::optional<std::size_t> unique;
    for (auto at = positions_.lower_bound({false, number, 0}); at != positions_.end(); ++at) {
      const auto& [other_is_id, other, other_home] = at->first;
      if (other_is_id || other != number) break;
      if (home != no_home && other_home != no_home) continue;
      if (unique) entity.damaged("has a seq_id of several tasks, but no home");
      unique = at->second;
    }
    return unique;
  }

  Snapshot s_;
  std::map<Name, std::size_t> positions_;
  std::map<std::uint64_t, std::size_t> blocks_;  // position of an id
  std::map<std::uint64_t, std::uint64_t> rank_working_bytes_;
  std::size_t highest_ = 0;  // PE of a task or block
  std::string highest_where_;
  std::size_t n_positions_ = 0;
  std::size_t n_left_out_ = 0;
};

/// A file may say that phases are as the one before them instead of writing them.
void refuse_unwritten_phases(const Place& file) {
  if (!file.has("metadata") || !file["metadata"].has("phases")) return;
  const Place phases = file["metadata"]["phases"];
  if (!phases.has("identical_to_previous")) return;
  const Place equal = phases["identical_to_previous"];
  for (const char* kind : {"list", "range"})
    if (equal.has(kind) && equal[kind].size() > 0)
      fail(ErrorCode::bad_file, file.where(),
           " metadata phases identical_to_previous: these phases are not written, and cannot be "
           "replayed; have the file written without it");
}

json parse(const LbDatafile& file) {
  try {
    return json::parse(file.text);
  } catch (const json::parse_error& e) {
    fail(ErrorCode::bad_file, file.name, ": not JSON from byte ", e.byte,
         " on; write it again, or if it is compressed, let its name end in .br");
  } catch (const json::exception&) {
    fail(ErrorCode::bad_file, file.name, ": has a number beyond all range; write it again");
  }
}

}  // namespace

std::vector<Phase> parse_lb_datafiles(const std::vector<LbDatafile>& files) {
  std::vector<json> documents;
  for (const LbDatafile& file : files) documents.push_back(parse(file));

  std::map<std::uint64_t, Gathering> phases;
  const auto each_phase = [&](auto visit) {
    for (std::size_t f = 0; f < files.size(); ++f) {
      const Place file(documents[f], files[f].name + ":");
      refuse_unwritten_phases(file);
      for (const Place& of : {file, file.has("metadata") ? file["metadata"] : file})
        if (of.has("type") && of["type"].word() != "LBDatafile")
          of["type"].damaged("is not LBDatafile");
      const Place all = file["phases"];
      if (all.size() == 0)
        fail(ErrorCode::bad_file, all.where(), ": none is there; give a file with a phase");
      for (std::size_t k = 0; k < all.size(); ++k)
        visit(phases[all.at(k)["id"].count()], all.at(k));
    }
  };
  each_phase([](Gathering& one, const Place& phase) { one.add_tasks(phase); });
  each_phase([](Gathering& one, const Place& phase) { one.add_communications(phase); });

  std::size_t n_pes = 1;
  for (const auto& [id, one] : phases) n_pes = std::max(n_pes, one.n_pes());
  std::vector<Phase> result;
  for (auto& [id, one] : phases) result.push_back({id, one.finish(n_pes), one.n_left_out()});
  return result;
}

}  // namespace tess::balance
