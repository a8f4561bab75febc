// All shapes; each has a source file.
#pragma once

#include "apps/bench/bench.hpp"

namespace bench {

Shape message_shape();
Shape creation_shape();
Shape collectives_shape();
Shape migration_shape();
Shape one_way_shape();
Shape work_shape();
Shape balance_shape();
Shape balance_round_shape();
Shape measuring_shape();
Shape timers_shape();

}  // namespace bench
