// What the balancer uses of the runtime's internals, by its short name in this namespace.
#pragma once

#include "runtime/collections/collection.hpp"
#include "runtime/collections/collection_action.hpp"
#include "runtime/collections/elements/balance_record.hpp"
#include "runtime/collections/elements/element.hpp"
#include "runtime/collections/reductions/reduction_tree.hpp"
#include "runtime/collections/reductions/typed_partial.hpp"
#include "runtime/core/registry.hpp"
#include "runtime/scheduler/meter.hpp"

namespace tess::balance {

using detail::BalanceRecord;
using detail::Collection;
using detail::Counted;
using detail::Element;
using detail::element_text;
using detail::ElementWatcher;
using detail::find_collection;
using detail::LoadRecord;
using detail::MergedPartial;
using detail::Meter;
using detail::PastLoad;
using detail::ReductionHostOfCollection;
using detail::ReductionTree;
using detail::Registry;
using detail::send_to_collection;
using detail::SyncEntry;
using detail::SyncPhase;
using detail::SyncState;
using detail::Track;

}  // namespace tess::balance
