// std::chrono's durations and clocks, which every program of the runtime includes. In C++20
// <chrono> also has calendars, time zones and their text, which bring the streams: 4 000 lines that
// the runtime does not need. A program that formats times includes <chrono>.
#pragma once

#if __has_include(<bits/chrono.h>)
#include <bits/chrono.h>  // NOLINT: of libstdc++ 11 and later
#else
#include <chrono>
#endif
