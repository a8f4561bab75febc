// Overset meshes: holes are cut where other meshes have bodies, and values are exchanged around
// them. Meshes overlap; each is an array of the application's own chares (coupling.hpp). For each
// mesh:
//
//     wall     Wall: the surface of the body in it               overset_boundary(), or a file
//     hole     its points inside or on walls of other meshes     exact, local to a piece
//     fringe   points near holes and on its outer boundary       local, with a halo as deep
//     donors   a coupling finds them for each pair of meshes     Coupling::search()
//     flags    the same coupling takes the flags of the donors   Coupling::apply()
//     settle   a fringe point takes the best donor without a hole; without any it is an orphan
//
// Sample: tests/samples/overset.cpp
//
//     void cut(const tess::m2m::Wall& wall) { blanking_.cut(mesh_view(), {&wall, 1}, on_outer_); }
//     std::span<const double> flags() const { return blanking_.flags(); }
//     std::span<double> offered(CouplingId from) { return blanking_.offered(from); }
//     void settle(CouplingId from, std::int32_t mesh_number) {
//       blanking_.settle(mesh_view(), from, status(from), mesh_number);
//     }
//     // …
//     co_await tess::epoch([&] {
//       background.broadcast<&Grid::cut>(wall);
//       overset.broadcast<&Grid::cut>(tess::m2m::Wall());
//     });
//     // …
//     co_await to_background.apply<&Grid::flags, &Grid::offered>();
//     co_await to_overset.apply<&Grid::flags, &Grid::offered>();
//     co_await tess::epoch([&] {
//       background.broadcast<&Grid::settle>(to_background.id(), 2);
//       overset.broadcast<&Grid::settle>(to_overset.id(), 1);
//     });
//
// After that, apply() takes fields; a piece uses those of mesh k where iblank() is -k. With three or
// more meshes several couplings give a piece values, each to memory of its own: like offered(), the
// accessor takes the CouplingId. If a mesh moves: cut, search, apply the flags and settle again. Send a large wall in
// parts (Wall::seen_from()). A body that contains no point of another mesh cuts no hole.
//
// Roles, donors and qualities depend only on the meshes and the walls: not on the number of PEs or
// pieces, or the order of messages.
#pragma once

#include "m2m/overset/blanking.hpp"
#include "m2m/overset/boundary.hpp"
#include "m2m/overset/roles.hpp"
#include "m2m/overset/symmetry.hpp"
#include "m2m/overset/wall.hpp"
