#!/usr/bin/env bash
# Each misuse of a coupling ends the job with exit code 1 and a line that says what is wrong.
#
#     misuse.sh PROGRAM
source "$(dirname "$0")/../../support/checks.sh"
program=$1

# ends MISUSE TEXT: for kinds of each sort, in one process and between processes.
ends() {
  for kind in linear second-order conservative conservative-bounded; do
    exits 1 "$2" "$program" "$1" "$kind" --sim pes=2,per-process=1,cost=100ns
  done
}

exits 0 "no misuse" "$program" none linear --pes 2
exits 0 "no misuse" "$program" none conservative --pes 2
ends two_first_searches "a coupling searches while a search or an application of it is under way: co_await that first"
ends two_searches "a coupling searches while a search or an application of it is under way: co_await that first"
ends search_meanwhile "a coupling searches while a search or an application of it is under way: co_await that first"
ends apply_meanwhile "a coupling is applied while a search of it is under way: co_await that first"
under_way="a coupling is destroyed while a search or an application of it is under way: co_await that first"
ends destroy_in_search "$under_way"
ends destroy_in_apply "$under_way"
twice="a coupling is applied by what an application to the same member of the target causes, such as received(): each would wait for the other"
ends apply_in_received "$twice"
ends apply_in_last "$twice"
ends no_arrays "a coupling without arrays is searched: give its constructor the arrays that create() returned"
ends source_ended "a coupling is applied after an array of its pieces was destroyed: make a new Coupling"
ends target_ended "a coupling is searched after an array of its pieces was destroyed: make a new Coupling"
ends copy_destroyed "a coupling is applied that another copy of the handle has destroyed: use the copy that called destroy()"
ends copy_searched "a coupling is searched that another copy of the handle has destroyed: use the copy that called destroy()"
ends shrunk "a piece has 4 rows of values, and had [0-9]* in the last search of the coupling: search again when points or tetrahedra change"
for kind in linear second-order; do
  exits 1 "a piece has 4 rows of values, and had [0-9]* in the last search of the coupling" "$program" weights_shrunk_source "$kind" --pes 2
  exits 1 "a piece owns 4 points, and owned [0-9]* in the last search of the coupling: search again when points change" \
    "$program" weights_shrunk_target "$kind" --pes 2
  exits 1 "the donors of a coupling are used while a search of it is under way: co_await that first" \
    "$program" weights_meanwhile "$kind" --pes 2
done
for misuse in settled_without_flags settled_twice; do
  exits 1 "the flags of mesh 1 were not taken since cut() and the last settle() of this coupling: apply() it to offered() before each settle()" \
    "$program" "$misuse" linear --sim pes=2,per-process=1,cost=100ns
done
ends vanished "a piece has 0 rows of values, and had [0-9]* in the last search"
exits 1 "two points of a piece have the id 7: point_ids and tet_ids are unique in the mesh" "$program" same_ids conservative --pes 2
for kind in linear conservative; do
  exits 2 "tetrahedra 0 and 1 of a piece have the same id 7: tet_ids are unique in the mesh" "$program" same_tet_ids "$kind" --pes 2
done
exits 2 "coupling [0-9]*: the source pieces \[[01]\] and \[[01]\] have tetrahedra of the same id [0-9]*: tet_ids are unique in the mesh" \
  "$program" same_tets linear --pes 2
ends source_gone "Patch\[1\], a source piece of coupling [0-9]*, was destroyed after the last search: search again before values are given"
ends forgotten "give as many rows, ghosts included\|give equally many"
ends source_moved "this piece is no source of the coupling: await search() first, use it before its destroy(), and serialise .couplings. if pieces migrate"
ends target_moved "this piece is no target of the coupling: await search() first, use it before its destroy(), and serialise .couplings. if pieces migrate"

finish
