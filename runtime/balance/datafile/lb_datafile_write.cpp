#include "runtime/balance/datafile/lb_datafile.hpp"
#include "runtime/balance/unknown_loads.hpp"

#include <map>
#include <nlohmann/json.hpp>

namespace tess::balance {
namespace {

using nlohmann::json;

/// An array of numbers or strings, as the index is written. The hash of the index if it is not
/// known.
json index_of(const Elements& e, std::size_t i) {
  if (e.index.empty()) return json::array({e.key[i].element});
  json index = json::parse(e.index[i], nullptr, false);
  return index.is_array() ? index : json::array({e.index[i]});
}

/// Sequence numbers and homes of elements: assigned at first appearance, equal in all phases and
/// files.
class Identities {
 public:
  explicit Identities(const std::vector<Phase>& phases) {
    for (const Phase& phase : phases) {
      const Elements& e = phase.snapshot.elements;
      for (std::size_t i = 0; i < e.size(); ++i)
        known_.try_emplace(e.key[i], Identity{known_.size() + 1, e.pe[i]});
    }
  }

  [[nodiscard]] json entity(const Elements& e, std::size_t i) const {
    const Identity& known = known_.at(e.key[i]);
    const bool migratable = e.migratable[i] != 0;
    const auto home = static_cast<std::uint64_t>(known.home.value);
    return {{"type", "object"},
            {"id", known.number << 18U | (home & 0xFFFFU) << 2U | (migratable ? 3U : 2U)},
            {"home", home},
            {"migratable", migratable},
            {"collection_id", e.key[i].array.value},
            {"index", index_of(e, i)}};
  }

 private:
  struct Identity {
    std::uint64_t number;
    PeId home;
  };
  std::map<ElementKey, Identity> known_;
};

/// As vt's balancers read it: they accept floating-point numbers only.
json memory(const Snapshot& s, std::size_t i) {
  const auto number = [](std::uint64_t bytes) { return static_cast<double>(bytes); };
  const Elements& e = s.elements;
  json user = {{"task_serialized_bytes", number(e.size_bytes[i])},
               {"task_footprint_bytes", number(e.memory_bytes[i])},
               {"task_working_bytes", number(e.working_bytes_of(i))},
               {"rank_working_bytes", number(s.pes.working_bytes_of(slot(e.pe[i])))}};
  if (e.block_of(i) == no_block) return user;
  const SharedBlock& block = s.blocks[e.block_of(i)];
  user["shared_id"] = number(block.id);
  user["shared_bytes"] = number(block.bytes);
  user["home_rank"] = number(slot(block.home));
  return user;
}

/// An unknown load is written as the `assumed` one, which other programs read.
json task(const Identities& identities, const Snapshot& s, std::size_t i, double assumed) {
  const Elements& e = s.elements;
  json user = memory(s, i);
  if (!e.load[i].is_known()) user["measured"] = 0;
  if (!e.position.empty()) {
    user["position_x"] = e.position[i][0];
    user["position_y"] = e.position[i][1];
    user["position_z"] = e.position[i][2];
  }
  return {{"entity", identities.entity(e, i)},
          {"node", e.pe[i].value},
          {"resource", "cpu"},
          {"time", e.load[i].seconds_or(assumed)},
          {"user_defined", std::move(user)}};
}

json communication(const Identities& identities, const Elements& e, const Edge& edge) {
  return {{"type", "SendRecv"},
          {"from", identities.entity(e, edge.from)},
          {"to", identities.entity(e, edge.to)},
          {"messages", edge.messages},
          {"bytes", static_cast<double>(edge.bytes)}};
}

json document(const Identities& identities, const Phase& phase, std::optional<PeId> rank) {
  const Snapshot& s = phase.snapshot;
  const auto wanted = [&](std::size_t element) { return !rank || s.elements.pe[element] == *rank; };
  const double assumed = mean_load(s);
  json tasks = json::array(), communications = json::array();
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    if (wanted(i)) tasks.push_back(task(identities, s, i, assumed));
  for (const Edge& edge : s.edges)
    if (wanted(edge.from)) communications.push_back(communication(identities, s.elements, edge));
  json pes = {{"pe_speed", s.pes.speed},
              {"pe_background", s.pes.background},
              {"pe_memory_limit_bytes", s.pes.memory_limit_bytes}};
  if (!s.pes.working_bytes.empty()) pes["pe_working_bytes"] = s.pes.working_bytes;
  return {{"id", phase.id},
          {"tasks", std::move(tasks)},
          {"communications", std::move(communications)},
          {"user_defined", std::move(pes)}};
}

}  // namespace

std::string write_lb_datafile(const std::vector<Phase>& phases, std::optional<PeId> rank) {
  const Identities identities(phases);
  json file = {{"type", "LBDatafile"}, {"metadata", {{"type", "LBDatafile"}}}};
  if (rank) file["metadata"]["rank"] = rank->value;
  file["phases"] = json::array();
  for (const Phase& phase : phases) file["phases"].push_back(document(identities, phase, rank));
  return file.dump(-1, ' ', false, json::error_handler_t::replace) + '\n';
}

}  // namespace tess::balance
