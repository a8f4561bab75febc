// std's algorithms without the overloads for ranges and execution policies, which are most of
// <algorithm>. For headers that every program includes; a program that uses the others includes
// <algorithm>.
#pragma once

#if __has_include(<bits/stl_algo.h>)
#include <bits/stl_algo.h>  // NOLINT: of libstdc++
#else
#include <algorithm>
#endif
