#include "m2m/coupling.hpp"

#include "m2m/couple/messages.hpp"
#include "m2m/coupling_weights.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <exception>
#include <tuple>
#include <utility>
#include <variant>

namespace tess::m2m {
namespace {

/// What a handle has started that is not done; a copy of the handle has started nothing.
struct UnderWay {
  int n_searches = 0, n_applications = 0;

  UnderWay() = default;
  UnderWay(const UnderWay& /*of_another_handle*/) {}
  UnderWay& operator=(const UnderWay& /*of_another_handle*/) { return *this; }
};
/// One of them, while it lives.
class OneUnderWay {
 public:
  explicit OneUnderWay(int& n) : n_(n) { ++n_; }
  ~OneUnderWay() { --n_; }
  OneUnderWay(const OneUnderWay&) = delete;
  OneUnderWay& operator=(const OneUnderWay&) = delete;

 private:
  int& n_;
};

/// Of an array or group of any class.
bool has_ended(CollectionId id) {
  return ArrayProxy<Ledger>(id).ended();
}

}  // namespace

void check(const CouplingOptions& options) {
  if (!(options.tolerance >= 0 && options.tolerance <= 1e100))
    fail(ErrorCode::bad_argument, "tolerance ", options.tolerance,
         " is not a length; choose 0 to 1e100 in units of the mesh");
  if (options.order < 1 || options.order > 2)
    fail(ErrorCode::bad_argument, "order ", options.order,
         " of moving least squares is not offered: choose 1 or 2");
  if (options.kind == TransferKind::moving_least_squares && options.tolerance > 0)
    fail(ErrorCode::bad_argument, "kind ", name_of(options.kind),
         " looks at no tetrahedron: leave out the tolerance, its points all get values");
  if (is_conservative(options.kind)) {
    if (options.clamp)
      fail(ErrorCode::bad_argument, "kind ", name_of(options.kind),
           " has no donors: clamp is for kinds that interpolate");
    if (std::holds_alternative<Nearest>(options.policy))
      fail(ErrorCode::bad_argument,
           "a conservative kind has no nearest vertex for what the source does not cover: choose "
           "policy keep or value");
    if (options.target_values == Centring::corners)
      fail(ErrorCode::bad_argument,
           "target values at corners are not offered: choose nodes or cells");
    return;
  }
  if (options.target_values != Centring::nodes)
    fail(ErrorCode::bad_argument, "kind ", name_of(options.kind),
         " gives values at points: show the centroids of the cells as the target's points, or "
         "choose a conservative kind for target values in cells");
  if (options.source_values == Centring::nodes) return;
  if (options.kind != TransferKind::linear && options.kind != TransferKind::projection)
    fail(ErrorCode::bad_argument, "kind ", name_of(options.kind),
         " takes values at nodes: choose linear, projection or a conservative kind for source "
         "values in cells or at their corners");
  if (std::holds_alternative<Nearest>(options.policy))
    fail(ErrorCode::bad_argument, "kind ", name_of(options.kind),
         " with source values in cells has no nearest vertex for points outside: choose policy "
         "keep or value, or a tolerance");
}

namespace detail {

void send_hits(const Callback<collide::Hits>& callback, collide::Hits&& hits) {
  const auto [target, coupling] = from_bytes<std::tuple<PieceArray, CouplingId>>(callback.where());
  target.send<&AnyPiece::m2m_hits>(hits.owner, coupling, std::move(hits));
}
const Callback<collide::Hits>::Kind hits_kind{naming::name_of<&send_hits>(), &send_hits};

void send_shared_points(const Callback<SharedPoints>& callback, SharedPoints&& shared) {
  const auto [target, coupling] = from_bytes<std::tuple<PieceArray, CouplingId>>(callback.where());
  target.send<&AnyPiece::m2m_receive>(shared.piece, SearchAnswer{coupling, {}, std::move(shared)});
}
const Callback<SharedPoints>::Kind shared_points_kind{naming::name_of<&send_shared_points>(),
                                                      &send_shared_points};

}  // namespace detail

struct AnyCoupling::State {
  PieceArray source, target;
  CouplingOptions options;
  CouplingSetup setup{};
  UnderWay under_way{};
  std::optional<CouplingSetup> forth{};  ///< of the coupling that this one is the transposed of
  LostForces lost{};

  void enter(const char* phase) const {
    if (options.on_phase != nullptr) (*options.on_phase)(phase);
  }
  /// Ends the job if the handle cannot be used: it has no arrays, an array has ended, or a copy of
  /// the handle has destroyed the coupling. `use`: "searched" or "applied".
  void require_usable(const char* use) const {
    TESS_CHECK(source.id() != CollectionId{} && target.id() != CollectionId{},
               "a coupling without arrays is ", use,
               ": give its constructor the arrays that create() returned");
    TESS_CHECK(
        !has_ended(source.id()) && !has_ended(target.id()), "a coupling is ", use,
        " after an array of its pieces was destroyed: make a new Coupling of arrays that exist");
    TESS_CHECK(
        setup.id == CouplingId{} || !has_ended(setup.ledger.id()), "a coupling is ", use,
        " that another copy of the handle has destroyed: use the copy that called destroy(), or "
        "make a new Coupling");
  }
  /// Creates what the search needs on all PEs.
  void set_up() {
    setup.source = source;
    setup.target = target;
    setup.policy = options.policy;
    setup.kind = options.kind;
    setup.tolerance = options.tolerance;
    setup.facing = options.facing;
    setup.clamp = options.clamp;
    setup.order = options.order;
    setup.source_values = options.source_values;
    setup.target_values = options.target_values;
    if (forth) setup.forth = forth->id;
    if (setup.collides())
      setup.collider =
          collide::make_collider({.voxel_size = options.voxel_size,
                                  .rules = {.within_model = collide::WithinModel::skip}});
    setup.ledger = create<Ledger>(each_pe);
    if (setup.has_directory()) setup.directory = create<PointDirectory>(each_pe);
    // Each coupling has its own ledger.
    setup.id = CouplingId{setup.ledger.id().value};
  }
  [[nodiscard]] std::vector<std::byte> target_bytes() const {
    return to_bytes(std::tuple(target, setup.id));
  }
};

AnyCoupling::AnyCoupling() : state_(std::make_unique<State>()) {}
AnyCoupling::AnyCoupling(const AnyCoupling& other)
    : state_(std::make_unique<State>(*other.state_)) {}
AnyCoupling& AnyCoupling::operator=(const AnyCoupling& other) {
  *state_ = *other.state_;
  return *this;
}
AnyCoupling::~AnyCoupling() = default;

AnyCoupling::AnyCoupling(PieceArray source, PieceArray target, CouplingOptions options)
    : state_(std::make_unique<State>(State{source, target, std::move(options)})) {
  CouplingOptions& given = state_->options;
  if (given.kind == TransferKind::nearest && std::holds_alternative<Keep>(given.policy))
    given.policy = Nearest{};
  if (given.kind == TransferKind::second_order && given.clamp) given.kind = TransferKind::limited;
}

AnyCoupling::AnyCoupling(const AnyCoupling& forth, LostForces lost) {
  const State& of = *forth.state_;
  of.require_usable("transposed");
  TESS_CHECK(of.setup.id != CouplingId{},
             "a coupling is transposed before its first search: co_await search() first");
  TESS_CHECK(!of.forth, "a transposed coupling is transposed: use the one that it was made of");
  require_weights(of.setup.kind, of.setup.clamp);
  if (of.setup.source_values != Centring::nodes)
    fail(ErrorCode::bad_argument, "a coupling with source values in ",
         rows_of(of.setup.source_values),
         " has no transposed one: forces go to points; couple with source values in nodes");
  // A point of S without a row gets the value 0.
  state_ = std::make_unique<State>(State{of.target, of.source, {.policy = UseValue{0}}});
  state_->forth = of.setup;
  state_->lost = lost;
}

template <class Ar>
void AnyCoupling::serialize(Ar& ar) {
  State& state = *state_;
  CouplingOptions& options = state.options;
  ar(state.source, state.target, state.setup, options.voxel_size, options.policy, options.kind,
     options.tolerance, options.facing, options.clamp, options.order, options.source_values,
     options.target_values, state.forth, state.lost);
}
template void AnyCoupling::serialize(Reader&);
template void AnyCoupling::serialize(Writer&);

CouplingId AnyCoupling::id() const {
  return state_->setup.id;
}
const collide::Collider& AnyCoupling::collider() const {
  return state_->setup.collider;
}
const CouplingSetup& AnyCoupling::setup() const {
  TESS_CHECK(state_->under_way.n_searches == 0,
             "the donors of a coupling are used while a search of it is under way: co_await that "
             "first");
  return state_->setup;
}

void AnyCoupling::destroy() {
  TESS_CHECK(state_->under_way.n_searches == 0 && state_->under_way.n_applications == 0,
             "a coupling is destroyed while a search or an application of it is under way: "
             "co_await that first");
  CouplingSetup& setup = state_->setup;
  if (setup.id == CouplingId{}) return;
  setup.source.broadcast<&AnyPiece::m2m_release>(setup.id);
  setup.target.broadcast<&AnyPiece::m2m_release>(setup.id);
  if (setup.collides()) setup.collider.destroy();
  setup.ledger.destroy();
  if (setup.has_directory()) setup.directory.destroy();
  setup = {};
}

TaskOf<SearchSummary> AnyCoupling::search() {
  State& state = *state_;
  TESS_CHECK(state.under_way.n_searches == 0 && state.under_way.n_applications == 0,
             "a coupling searches while a search or an application of it is under way: co_await "
             "that first");
  state.require_usable("searched");
  TESS_CHECK(!state.forth || !has_ended(state.forth->ledger.id()),
             "a transposed coupling is searched after the one that it was made of was destroyed: "
             "destroy that later, or transpose a new one");
  const OneUnderWay one(state.under_way.n_searches);
  state.enter("broad");
  const Time start = now();
  co_await collide_covers();
  const Time broad = now();
  state.enter("narrow");
  const LedgerPage found = co_await find_sources();
  if (found.tally.n_lost > 0 && state.lost == LostForces::refuse)
    fail(ErrorCode::bad_mesh, found.tally.n_lost,
         " points that give forces have no donor, and their forces would be lost: couple forth "
         "with policy Nearest{} or a tolerance, or allow it by LostForces::allow");
  co_return SearchSummary{seconds(broad - start), seconds(now() - broad), found.tally, found.worst};
}

Task AnyCoupling::collide_covers() {
  State& state = *state_;
  const CouplingSetup& setup = state.setup;
  const bool is_new = setup.id == CouplingId{};
  if (is_new) check(state.options);
  co_await epoch([&] {
    if (is_new) state.set_up();
    setup.ledger.broadcast<&Ledger::keep_pieces>(setup.source.id());
    setup.source.broadcast<&AnyPiece::m2m_submit>(setup, source_model);
    setup.target.broadcast<&AnyPiece::m2m_submit>(setup, target_model);
  });
  if (!setup.collides()) co_return;
  co_await setup.collider.run(
      {Callback<collide::Hits>(detail::hits_kind, state.target_bytes()), target_model});
}

/// Brings the weights of a transposed coupling to the target pieces, then to the owners of ghosts.
Task AnyCoupling::pass_rows() const {
  const CouplingSetup& setup = state_->setup;
  co_await epoch([&] { setup.source.broadcast<&AnyPiece::m2m_name_points>(setup.id); });
  co_await epoch([&] { setup.target.broadcast<&AnyPiece::m2m_ask>(setup.id); });
}

/// Only points that are in no tetrahedron need to know all source pieces, and pieces without
/// sources one of them.
TaskOf<LedgerPage> AnyCoupling::find_sources() {
  const CouplingSetup& setup = state_->setup;
  if (setup.has_directory()) {
    co_await epoch([&] {
      setup.directory.broadcast<&PointDirectory::resolve>(
          Callback<SharedPoints>(detail::shared_points_kind, state_->target_bytes()));
    });
  }
  if (setup.is_transposed()) co_await pass_rows();
  co_await epoch([&] { setup.target.broadcast<&AnyPiece::m2m_ask>(setup.id); });
  LedgerPage found = co_await setup.ledger.reduce<&Ledger::close_page>();
  if (found.n_waiting == 0 && found.n_alone == 0) co_return found;
  co_await epoch([&] { setup.source.broadcast<&AnyPiece::m2m_name>(setup.id); });
  LedgerPage page = co_await setup.ledger.reduce<&Ledger::close_page>();
  std::sort(page.sources.begin(), page.sources.end(),
            [](const SourcePiece& a, const SourcePiece& b) { return a.owner < b.owner; });
  if (found.n_waiting == 0 && page.sources.size() > 1) page.sources.resize(1);
  co_await epoch(
      [&] { setup.target.broadcast<&AnyPiece::m2m_receive_names>(setup.id, page.sources); });
  if (found.n_waiting == 0) co_return found;
  page = co_await setup.ledger.reduce<&Ledger::close_page>();
  found += page;
  co_return found;
}

Task AnyCoupling::apply(detail::Giver give, detail::Taker take,
                        std::function<void(CouplingId)> last) {
  State& state = *state_;
  const CouplingSetup& setup = state.setup;
  TESS_CHECK(setup.id != CouplingId{},
             "a coupling is applied before its first search: "
             "co_await search() first");
  TESS_CHECK(state.under_way.n_searches == 0,
             "a coupling is applied while a search of it is under way: co_await that first");
  const OneUnderWay one(state.under_way.n_applications);
  state.require_usable("applied");
  const std::shared_ptr<Turns> turns = setup.ledger.local().turns();
  co_await turns->take(take->channel);
  std::exception_ptr thrown;  // the next one has its turn all the same
  try {
    state.require_usable("applied");
    co_await epoch([&, id = setup.id] {
      turns->begins(take->channel);
      setup.ledger.broadcast<&Ledger::require_pieces>(id, setup.source.id());
      setup.source.broadcast<&AnyPiece::m2m_give_values>(id, give, take);
      setup.target.broadcast<&AnyPiece::m2m_take_if_alone>(id, take);
    });
    if (last)
      co_await epoch([&] {
        turns->begins(take->channel);
        last(setup.id);
      });
  } catch (...) {
    thrown = std::current_exception();
  }
  turns->pass_on(take->channel);
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace tess::m2m
