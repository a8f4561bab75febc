// What the balancer uses of the runtime's internals, by its short name in this namespace.
#pragma once

#include "runtime/arrays/collection.hpp"
#include "runtime/arrays/collection_action.hpp"
#include "runtime/arrays/elements/balance_record.hpp"
#include "runtime/arrays/elements/element.hpp"
#include "runtime/base/first_few.hpp"
#include "runtime/core/registry.hpp"
#include "runtime/pe/meter.hpp"
#include "runtime/reduce/reduction_tree.hpp"
#include "runtime/reduce/typed_partial.hpp"

namespace tess::balance {

using detail::BalancedElements;
using detail::BalanceRecord;
using detail::Collection;
using detail::Counted;
using detail::Element;
using detail::element_text;
using detail::ElementWatcher;
using detail::find_collection;
using detail::FirstFew;
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
