// The core: what most chare programs need. Beside it, with headers of their own: runtime/balance.hpp,
// runtime/checkpoint.hpp, runtime/command_line.hpp, and what stands in runtime/more/: sections, scans,
// interfaces, single chares, objects of processes, maps of indices, when_all, tests, traces.
#pragma once

#include "runtime/array.hpp"
#include "runtime/ask.hpp"
#include "runtime/callback.hpp"
#include "runtime/chare.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/ids.hpp"
#include "runtime/core/index.hpp"
#include "runtime/core/serialize.hpp"
#include "runtime/epoch.hpp"
#include "runtime/future.hpp"
#include "runtime/group.hpp"
#include "runtime/here.hpp"
#include "runtime/mailbox.hpp"
#include "runtime/reduction.hpp"
#include "runtime/run.hpp"
#include "runtime/sends.hpp"
#include "runtime/task.hpp"
#include "runtime/timer.hpp"
