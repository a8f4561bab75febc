// Everything a chare program needs.
#pragma once

#include "runtime/array.hpp"
#include "runtime/callback.hpp"
#include "runtime/chare.hpp"
#include "runtime/check.hpp"
#include "runtime/epoch.hpp"
#include "runtime/error.hpp"
#include "runtime/future.hpp"
#include "runtime/group.hpp"
#include "runtime/ids.hpp"
#include "runtime/index.hpp"
#include "runtime/mailbox.hpp"
#include "runtime/reduction.hpp"
#include "runtime/room.hpp"
#include "runtime/run.hpp"
#include "runtime/serialize.hpp"
#include "runtime/task.hpp"
