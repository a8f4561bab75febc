// Strategies without a run: for unit tests of a program's own strategy, and to compare strategies
// on snapshots that a run saved (lb_lab --save-snapshot, or vt's tools).
//
//     balance::Snapshot            elements and PEs, filled by a test, or read from a file
//     balance::Load                the seconds of an element, or unknown: it must be asked
//     balance::read_lb_datafiles   the phases of saved snapshots
//     balance::make_strategy       a strategy by name, or the user's own, with the rules of a run:
//                                  elements that may not move, and that have no room, stay
//     balance::register_strategy   adds the user's own to those with a name
//     balance::load_strategy_library   the same from a shared library
//     balance::measure             imbalance, moves and traffic of an assignment
//
// Nothing here needs a machine; each function may be called on any thread.
#pragma once

#include "runtime/balance/datafile/lb_datafile.hpp"
#include "runtime/balance/load.hpp"
#include "runtime/balance/metrics.hpp"
#include "runtime/balance/snapshot.hpp"
#include "runtime/balance/strategy.hpp"
