// The test framework, in one place: precompiled once, used by every test program.
#pragma once
#include <catch2/catch.hpp>

using Catch::Contains;
