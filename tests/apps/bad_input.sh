#!/usr/bin/env bash
# bad_input.sh BIN: bad input gives one line of error that names it, exit code 2, and no output files.
source "$(dirname "$0")/../support/checks.sh"
bin=$1

# refuses WORD COMMAND…: the command exits with 2, and prints one line with WORD to standard error.
refuses() {
  local word=$1
  shift
  "$@" >"$scratch/out" 2>"$scratch/err" </dev/null
  local code=$?
  if [[ $code -eq 2 && $(wc -l <"$scratch/err") -eq 1 && ! -e $scratch/result.exo && ! -e $scratch/result.json ]] &&
    grep -q -- "$word" "$scratch/err"; then
    pass
  else
    fail "$* (exit $code, wanted 2 and one line with '$word'):"
    cat "$scratch/err"
  fi
}

transfer=("$bin/m2m_transfer" --out "$scratch/result.exo" --json "$scratch/result.json")
: >"$scratch/empty.exo"
printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 nan 0\n4 0 0 1\n$EndNodes\n$Elements\n1\n1 4 2 0 0 1 2 3 4\n$EndElements\n' >"$scratch/nan.msh"
printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n0\n$EndElements\n' >"$scratch/none.msh"
printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n' >"$scratch/short.msh"

# Boxes whose coordinates have collapsed.
source "$(dirname "$0")/box_mesh.sh"
box "$scratch/box.msh" 1 0
box "$scratch/far.msh" 1 1e15
box "$scratch/tiny.msh" 1e-150 0
box "$scratch/point.msh" 1e-322 0
"$bin/m2m_transfer" "$scratch/box.msh" kuhn:4 >"$scratch/out" || fail "box.msh is refused"
refuses "far.msh: .* shift the mesh" "${transfer[@]}" "$scratch/far.msh" kuhn:2
refuses "far.msh: .* shift the mesh" "${transfer[@]}" kuhn:2 "$scratch/far.msh"
refuses "tiny.msh: .* rescale the mesh" "${transfer[@]}" "$scratch/tiny.msh" "$scratch/tiny.msh"
refuses "point.msh: .* rescale the mesh" "${transfer[@]}" "$scratch/point.msh" kuhn:2

refuses missing.exo "${transfer[@]}" "$scratch/missing.exo" kuhn:2
refuses missing.stl "${transfer[@]}" "$scratch/missing.stl" kuhn:2
refuses empty.exo "${transfer[@]}" kuhn:2 "$scratch/empty.exo"
refuses nan.msh "${transfer[@]}" kuhn:2 "$scratch/nan.msh"
refuses none.msh "${transfer[@]}" "$scratch/none.msh" kuhn:2
refuses "trace needs the name of a file" "${transfer[@]}" kuhn:2 kuhn:2 --trace=
refuses short.msh "${transfer[@]}" "$scratch/short.msh" kuhn:2
refuses kuhn:0 "${transfer[@]}" kuhn:0 kuhn:2
refuses --pes "${transfer[@]}" kuhn:2 kuhn:2 --pes 0
refuses --nonsense "${transfer[@]}" kuhn:2 kuhn:2 --nonsense
refuses TARGET "${transfer[@]}" kuhn:2
refuses policy "${transfer[@]}" kuhn:2 kuhn:2 --policy perhaps
refuses partition "${transfer[@]}" kuhn:2 kuhn:2 --partition perhaps
refuses perhaps "${transfer[@]}" kuhn:2 kuhn:2 --field 'perhaps(x)'
refuses "--voxel: -1 is not a number above 0" "${transfer[@]}" kuhn:2 kuhn:2 --voxel=-1
refuses "^m2m_transfer: error: --voxel 1e-12 .* at least" "${transfer[@]}" kuhn:2 kuhn:2 --pes 2 --voxel 1e-12
refuses --sim "${transfer[@]}" kuhn:2 kuhn:2 --sim pes=none
refuses --pes "$bin/hello" --pes 0
refuses "--sim seeds=1..9: this program has no search for races; link it with Tessera::testing" "$bin/tutorial_01_hello" --sim seeds=1..9
for wrong in "seeds=5..2" "seeds=5" "compare=x" "seeds=1..3,seed=2" "seeds=1..3,compare=never-printed"; do
  refuses "--sim [a-z]*: .*" "$bin/ring" --sim "$wrong"
done
refuses "--sim seeds=1..3 --pes 2" "$bin/ring" --pes 2 --sim seeds=1..3
refuses "a second run in the plain order differs: exit code 2" "$bin/stencil" --sim seeds=1..3,compare=hash --checkpoint "$scratch/twice"
"$bin/stencil" --sim seeds=1..3,compare=hash >"$scratch/out" 2>&1 && grep -qE "^hash [0-9a-f]+$" "$scratch/out" && pass || fail "what follows a word is not compared alone"
TESS_TEST_REPEAT=seed=1,keep=deadbeef "$bin/stencil" --sim seeds=1..3,compare=hash >"$scratch/out" 2>&1
grep -q "seed 1 lacks 1 of 1 decisions here" "$scratch/out" && pass || fail "a decision of another program is not named"
"$bin/hello" >/dev/full 2>"$scratch/err"
[[ $? -eq 2 ]] && grep -q "standard output: a part of it could not be written" "$scratch/err" && pass || fail "lost output is no error"
refuses "--pes: 100000 is not a whole number from 1 to 4096" "$bin/hello" --pes 100000
# Threads with stacks of a gigabyte, for a few of which there is room.
few_threads() {
  (ulimit -s 1000000 && ulimit -v 6000000 && "$@")
}
few_threads true && refuses "hello: error: --pes 16: this system starts no more than [1-9] threads (.*); give fewer PEs" few_threads "$bin/hello" --pes 16
refuses --nonsense "$bin/hello" --nonsense
refuses "--monitor 0: this program has no live view; link it with Tessera::live_view" "$bin/hello" --monitor 0
refuses "more than once" "${transfer[@]}" kuhn:2 kuhn:2 --policy keep --policy nearest
refuses SOURCE "${transfer[@]}"
refuses "no --pairs" "${transfer[@]}" kuhn:2 kuhn:2 kuhn:3
refuses "--repeat 3 does not work with --pairs that write a mesh after it gave values" "${transfer[@]}" kuhn:2 kuhn:3 --pairs A:B,B:A --repeat 3
refuses "'A:D' is no pair" "${transfer[@]}" kuhn:2 kuhn:2 kuhn:3 --pairs A:B,A:D
refuses "--steps 2 does not work with --weights" "${transfer[@]}" kuhn:2 kuhn:2 --steps 2 --weights "$scratch/w.nc"
"$bin/m2m_transfer" kuhn:2 kuhn:2 --weights "$scratch/w.nc" >"$scratch/out" || fail "no weights are written"
for unused in "--kind nearest" "--tolerance 0.1" --clamp "--partition rcb" "--voxel 2"; do
  refuses "$unused does not work with --from-weights" "${transfer[@]}" kuhn:2 kuhn:2 --from-weights "$scratch/w.nc" $unused
done
refuses "--chares 2 does not work with --from-weights" "${transfer[@]}" kuhn:2 kuhn:2 --from-weights "$scratch/w.nc" --chares 2
refuses "'sideways(1)' is no motion" "${transfer[@]}" kuhn:2 kuhn:2 --steps 2 --move 'sideways(1)'
refuses "--vector: needs --move A:rotate" "${transfer[@]}" kuhn:2 kuhn:2 --vector sin
refuses "--vector sin: the field has 1 component, and a vector has 3" "${transfer[@]}" kuhn:2 kuhn:2 --fields sin --vector sin --steps 2 --move 'A:rotate(0,0,1,5deg)'
refuses "--repeat .* --move" "${transfer[@]}" kuhn:2 kuhn:2 --repeat 2 --steps 2 --move 'translate(1,0,0)'
refuses "--round-trips: '2,1'" "$bin/m2m_transfer" --json "$scratch/result.json" kuhn:2 kuhn:2 --round-trips 2,1
"$bin/m2m_transfer" kuhn:2 kuhn:2 --round-trips 1 --kind all >"$scratch/out" || fail "--round-trips refuses --kind all"
"$bin/m2m_transfer" kuhn:2 kuhn:3 --kind all --clamp --reference radial-basis --field x >"$scratch/out" || fail "--kind all refuses --clamp"
grep -q "^radial-basis" "$scratch/out" && grep -q "^left out: --clamp .*, and conservative " "$scratch/out" ||
  fail "--kind all --clamp: no row of the reference, or no word on what it leaves out"
refuses "--move .* --round-trips" "$bin/m2m_transfer" kuhn:2 kuhn:2 --round-trips 1 --move 'translate(1,0,0)'
refuses "--order 2 is for kind moving-least-squares, not linear" "${transfer[@]}" kuhn:2 kuhn:2 --order 2
refuses "--reference rbf is unknown; choose radial-basis" "${transfer[@]}" kuhn:2 kuhn:2 --reference rbf
refuses "radial basis: 24389 points need a matrix of 4.7" "${transfer[@]}" kuhn:28 kuhn:2 --reference radial-basis
refuses "--watch: '1,2' is no point" "${transfer[@]}" kuhn:2 kuhn:2 --watch 1,2
refuses "--watch takes values at points, and kind conservative" "${transfer[@]}" kuhn:2 kuhn:2 --watch 1,1,1 --kind conservative
refuses "--watch-file: needs --watch" "${transfer[@]}" kuhn:2 kuhn:2 --step 0 --watch-file "$scratch/w.csv"
# Options that do not work together, or would overwrite an input.
alone=("$bin/m2m_transfer" kuhn:2 kuhn:3)
refuses "--plot: needs --study or --round-trips" "${alone[@]}" --plot "$scratch"
refuses "--move: needs --steps" "${alone[@]}" --move 'translate(1,0,0)'
refuses "--chares 5 does not work with --per-pe 3" "${alone[@]}" --chares 5 --per-pe 3
refuses "--study does not work with --round-trips" "${alone[@]}" --round-trips 1 --study h
refuses "--steps 5 does not work with --round-trips" "${alone[@]}" --round-trips 1 --steps 5
refuses "--kind linear does not work with --stability" "${alone[@]}" --kind linear --stability
refuses "MORE kuhn:4 does not work with --stability" "${alone[@]}" kuhn:4 --stability
refuses "--fields: x is given twice" "${transfer[@]}" kuhn:2 kuhn:2 --fields x,sin --fields x
refuses "--fields sin does not work with --stability" "${alone[@]}" --stability --fields sin
refuses "--voxel 0.5 does not work with --stability" "${alone[@]}" --stability --voxel 0.5
refuses "--per-pe 3 does not work with --stability" "${alone[@]}" --stability --per-pe 3
refuses "--policy is given more than once" "${alone[@]}" --stability --policy keep --policy nearest
refuses "policy 'perhaps' is unknown" "${alone[@]}" --stability --policy perhaps
refuses "partition method 'perhaps'" "${alone[@]}" --stability --partition perhaps
refuses "^m2m_transfer: error: --json .* cannot be written" "${alone[@]}" --stability --json "$scratch/missing/x.json"
refuses "--stability takes no value" "${alone[@]}" --stability=true
mkdir "$scratch/lone" && cp "$bin/m2m_transfer" "$scratch/lone"
refuses "^m2m_transfer: error: --stability: m2m_stability is not beside this program; build it" "$scratch/lone/m2m_transfer" --stability
# Several chares find it.
refuses "must be finite and at most 1e100" "${alone[@]}" --pes 2 --steps 20 --move 'B:translate(9e99,0,0)'
refuses "--move .* does not work with --study" "${alone[@]}" --study steps --move 'translate(1,0,0)'
refuses "--pairs B:A does not work with --study" "${alone[@]}" --study h --pairs B:A
refuses "MORE kuhn:4 does not work with --weights" "${alone[@]}" kuhn:4 --weights "$scratch/w.nc"
refuses "--repeat 3 does not work with --weights" "${alone[@]}" --repeat 3 --weights "$scratch/w.nc"
refuses "--out .* does not work with --kind all" "${alone[@]}" --kind all --out "$scratch/all.exo"
refuses "--picture .* --kind all" "${alone[@]}" --kind all --picture "$scratch/cut.svg"
refuses "--kind all does not work with --study steps" "${alone[@]}" --kind all --study steps
refuses "--policy nearest is for kinds that interpolate, and conservative" "${alone[@]}" --kind conservative --policy nearest
refuses "--source-part ''.* names no part" "${alone[@]}" --source-part ""
refuses "--clamp is for kinds that interpolate" "${alone[@]}" --kind conservative --clamp
cp "$scratch/box.msh" "$scratch/kept.msh"
refuses "would overwrite TARGET" "$bin/m2m_transfer" kuhn:2 "$scratch/kept.msh" --out "$scratch/./kept.msh"
refuses "would overwrite SOURCE" "$bin/m2m_transfer" "$scratch/kept.msh" kuhn:2 --json "$scratch/kept.msh"
refuses "kept.xyz: the ending chooses the format; give .exo" "${alone[@]}" --out "$scratch/kept.xyz"
refuses "mesh kuhn:3 has no part 'wall': there are skin" "${alone[@]}" --target-part wall
refuses "--source-part skin does not work with --study" "${alone[@]}" --source-part skin --study h
refuses "r.pvtu: fields of files are gathered" "${alone[@]}" --out "$scratch/r.pvtu" --weights "$scratch/w.nc"
refuses "missing/r.pvtu" "${alone[@]}" --out "$scratch/missing/r.pvtu"
refuses "XML, which names the parts, cannot hold this name" "${alone[@]}" --out "$scratch/"$'r\xf6.pvtu'
refuses "cut.png: a picture's name must end in .svg" "${alone[@]}" --picture "$scratch/cut.png"
refuses "would overwrite --json" "${alone[@]}" --out "$scratch/same.exo" --json "$scratch/same.exo"
refuses "would overwrite SOURCE" "$bin/m2m_transfer" "$scratch/kept.msh" kuhn:2 --trace "$scratch/kept.msh"
cp "$scratch/box.msh" "$scratch/kept2.msh"
refuses "would overwrite SOURCE" "$bin/m2m_transfer" "$scratch/kept.msh,$scratch/kept2.msh" kuhn:3 --study h --json "$scratch/kept.msh"
refuses "would overwrite OVERSET" "$bin/overset" kuhn:8 "$scratch/kept.msh" --json "$scratch/kept.msh"
cmp -s "$scratch/box.msh" "$scratch/kept.msh" || fail "a mesh that is read was overwritten"
# Names that --out derives, of parts and of several results.
"$bin/m2m_transfer" kuhn:2 kuhn:2 --out "$scratch/r.1.vtu" >"$scratch/out"
"$bin/m2m_transfer" kuhn:2 kuhn:2 --out "$scratch/r.B.exo" >"$scratch/out"
refuses "would overwrite SOURCE" "$bin/m2m_transfer" "$scratch/r.1.vtu" kuhn:2 --fields x --chares 2 --out "$scratch/r.pvtu"
refuses "would overwrite SOURCE" "$bin/m2m_transfer" "$scratch/r.B.exo" kuhn:3 kuhn:2 --fields x --pairs A:B,A:C --out "$scratch/r.exo"
"$bin/m2m_transfer" "$scratch/r.B.exo" kuhn:3 --fields x --out "$scratch/r.exo" >"$scratch/out" || fail "one result has the name given"
refuses kind "${transfer[@]}" kuhn:2 kuhn:2 --kind perhaps
refuses "--plot" "$bin/m2m_transfer" kuhn:2 kuhn:3 --study kind --plot "$scratch/empty.exo"
refuses "--study kinds: is none of h, kind, steps and pes" "$bin/m2m_transfer" kuhn:2 kuhn:3 --study kinds
refuses missing.msh "$bin/m2m_transfer" --json "$scratch/result.json" "$scratch/missing.msh" --stability

overset=("$bin/overset" --json "$scratch/result.json")
refuses "log(x-2)" "${overset[@]}" kuhn:8 ball:4 --field "log(x-2)"
refuses "kuhn:3 has no cavity" "${overset[@]}" kuhn:4 kuhn:3
refuses "ball:1: give a number" "${overset[@]}" kuhn:4 ball:1
refuses "no side set body; it has none (ExodusII and gmsh" "${overset[@]}" kuhn:4 ball:4 --wall body
refuses "missing.obj" "${overset[@]}" kuhn:4 kuhn:4 --wall "$scratch/missing.obj"
printf 'v .1 .1 .1\nv .9 .1 .1\nv .1 .9 .1\nf 1 2 3\n' >"$scratch/sheet.obj"
refuses "the wall is open" "${overset[@]}" kuhn:4 kuhn:4 --wall "$scratch/sheet.obj"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 4 3\n' >"$scratch/turned.obj"
refuses "not oriented alike: triangles 0 and 1 .*between (0, 0, 0) and (1, 0, 0)" "${overset[@]}" kuhn:4 kuhn:4 --wall "$scratch/turned.obj"
printf 'v .4 .4 0\nv .6 .4 0\nv .5 .6 0\nv .5 .5 .2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n' >"$scratch/tent.obj"
refuses "rim lies in z=0, which is a boundary of the background: give --symmetry z=0" "${overset[@]}" kuhn:4 kuhn:4 --wall "$scratch/tent.obj"
sed 's/f 2 3 4/f 3 2 4/' "$scratch/tent.obj" >"$scratch/turned_tent.obj"
refuses "not oriented alike" "${overset[@]}" kuhn:4 kuhn:4 --wall "$scratch/turned_tent.obj" --symmetry z=0
refuses "symmetry y=0: no wall has a rim in it" "${overset[@]}" kuhn:4 ball:4@.5:.5:.5 --symmetry y=0
refuses "z=0.5 is no plane of symmetry: the domain reaches 0.5 to one" "${overset[@]}" kuhn:4 ball:4 --symmetry z=0.5
refuses "z=-1 is no plane of symmetry: the domain ends 1 from it" "${overset[@]}" kuhn:4 ball:4 --symmetry z=-1
refuses "symmetry z=0 is given twice" "${overset[@]}" kuhn:4 ball:4 --symmetry z=0,z=0
refuses "symmetry w=0 is no plane" "${overset[@]}" kuhn:4 ball:4 --symmetry w=0
refuses "crosses the plane of symmetry across z; give an even" "${overset[@]}" kuhn:4 ball:5 --symmetry z=0
refuses "ball:4@.5:.5: after @ give a centre" "${overset[@]}" kuhn:4 ball:4@.5:.5
refuses "least-quality" "${overset[@]}" --least-quality 2
refuses "layers" "${overset[@]}" --layers 0
refuses "kuhn:4 cannot be refined" "${overset[@]}" kuhn:4 kuhn:4 --study h
refuses "ball:8 cannot be refined" "${overset[@]}" kuhn:8,16 ball:8 --study h
refuses "BACKGROUND kuhn:16 is no ladder" "${overset[@]}" kuhn:16 --study h
refuses "BACKGROUND kuhn:16,8 is no ladder" "${overset[@]}" kuhn:16,8 ball --study h
refuses "BACKGROUND kuhn:8,15 is no ladder" "${overset[@]}" kuhn:8,15 ball --study h
refuses "BACKGROUND kuhn:8,16 does not work with --study wall" "$bin/overset" kuhn:8,16 ball --study wall
refuses "--field sin does not work with --study wall" "$bin/overset" --field sin --study wall
refuses "--wall body does not work with --study h" "${overset[@]}" --study h --wall body
refuses "--plot .* does not work with --study wall" "$bin/overset" --study wall --plot "$scratch"
mkdir "$scratch/meshes" && "$bin/m2m_transfer" kuhn:2 kuhn:4 --out "$scratch/meshes/background.exo" >"$scratch/out"
refuses "--plot .* would overwrite" "$bin/overset" "$scratch/meshes/background.exo" ball:2 --plot "$scratch/meshes"

refuses "--time 1e+09 takes .* steps" "$bin/coupled" --time 1e9
refuses "--time: nan is not a number above 0" "$bin/coupled" --time nan
refuses "--substeps 3 .* --reaction" "$bin/coupled" --substeps 3
refuses "--balance-every 3 .* --balance" "$bin/coupled" --balance-every 3

# Options that a program would ignore.
refuses "--balance: is empty" "$bin/coupled" --balance ''
refuses "--balance: is empty" "$bin/amr" --balance ''
refuses "--balance: is empty" "$bin/leanmd" --balance ''
refuses "--expect 99: --first does not count" "$bin/nqueens" 8 --first --expect 99
for unused in "--form chares" "--grain 4" --first; do
  refuses "$unused does not work with --study" "$bin/nqueens" 8 --study $unused
done
refuses "--order 3 does not work with --study" "$bin/amr" --study --order 3
for unused in "--atoms 500" "--cells 2,2,2" "--dt 0.1" --check "--balance greedy" "--seed 2"; do
  refuses "$unused does not work with --stability" "$bin/leanmd" --stability $unused
done
refuses "--json $scratch/result.json would overwrite --trace" "$bin/stencil" --json "$scratch/result.json" --trace "$scratch/result.json"
refuses "--checkpoint /dev/null/saved: cannot be written: /dev/null is no folder" "$bin/stencil" --size 8 --steps 2 --checkpoint /dev/null/saved
for unused in --log-steps "--checkpoint $scratch/saved" "--restart $scratch/saved"; do
  refuses "$unused does not work with --repeat" "$bin/stencil" --repeat 3 $unused
done
refuses "--repeat" "$bin/stencil" --repeat 0
for unused in "--balance greedy" "--order 3" "--max-level 3" "--steps 4"; do
  refuses "$unused does not work with --stability" "$bin/amr" --stability $unused
done
refuses "--by: needs a --heat map" "$bin/tess_monitor" --by pe
refuses "--level '': give single or funneled" "$bin/embedded" --level
refuses "--level 'double'" "$bin/embedded" --pes 1 --level double

crowd=("$bin/collide_scene" crowd:2048 --study pes --machines 1)
refuses "no balance strategy 'gredy'" "${crowd[@]}" --balance gredy
refuses "--steps 5: greedy_refine balances after every 5 steps" "${crowd[@]}" --steps 5 --balance greedy_refine
refuses "--machines: Value 0 not in range" "$bin/collide_scene" crowd:2048 --study pes --machines 1,0
refuses "3 PEs do not divide into processes of 2" "$bin/collide_scene" crowd:2048 --study pes --machines 4,3 --network per-process=2
refuses "--network pes=3 names a number of PEs" "${crowd[@]}" --network pes=3
refuses "--weak: .*box.msh is no scene made by rule" "$bin/collide_scene" "$scratch/box.msh" --study pes --weak
refuses "--machines: needs --study pes" "$bin/collide_scene" crowd:2048 --machines 1
refuses "--balance none does not work with --study voxels" "$bin/collide_scene" crowd:2048 --study voxels --balance none
refuses "--triangles does not work with --study pes" "${crowd[@]}" --triangles
refuses "--stability: needs no PEs" "$bin/collide_scene" --stability --pes 2
refuses "^collide_scene: error: INPUT crowd:2048 does not work with --stability" "$bin/collide_scene" --stability crowd:2048
refuses "^particles: error: --steps 5 does not work with --stability" "$bin/particles" --stability --steps 5
refuses "^collide_scene: error: voxel grid: coordinate" "$bin/collide_scene" boxes:100 --pes 2 --voxel-size 1e-30

scaling=("$bin/m2m_transfer" --study pes --repeat 1 --machines)
refuses "missing.exo: cannot be opened" "${scaling[@]}" 1 "$scratch/missing.exo" kuhn:2
refuses "nan.msh: vertex" "${scaling[@]}" 1 kuhn:2 "$scratch/nan.msh"
refuses "--kind all does not work with --study pes" "${scaling[@]}" 1 kuhn:2 kuhn:2 --kind all
refuses "--network pes=3 names a number of PEs" "${scaling[@]}" 1 kuhn:2 kuhn:2 --network pes=3
refuses "--sim: 3 PEs do not divide into processes of 2" "${scaling[@]}" 4,3 kuhn:2 kuhn:3 --network per-process=2
refuses "--study pes simulates its machines" "${scaling[@]}" 1 kuhn:2 kuhn:3 --sim pes=2
refuses "--machines: needs --study pes" "${alone[@]}" --machines 1,2
refuses "--machines 1,2 does not work with --study" "${alone[@]}" --study h --machines 1,2
# Each machine is the one of --network, and has its forced migrations.
"${scaling[@]}" 1,2,6 kuhn:2 kuhn:3 --network per-process=2 >"$scratch/out" && pass || fail "--study pes refuses per-process=2"
for chance in 0 0.5; do
  "${scaling[@]}" 2 kuhn:2 kuhn:3 --network seed=3,cost=1ms,migrate=$chance >"$scratch/out" && tail -n 1 "$scratch/out" >"$scratch/migrate.$chance" && pass || fail "--study pes, migrate=$chance"
done
! cmp -s "$scratch/migrate.0" "$scratch/migrate.0.5" && pass || fail "--study pes migrates nothing"
refuses "empty.exo" "${scaling[@]}" 1 kuhn:2 kuhn:2 --plot "$scratch/empty.exo"

# A study leaves nothing in its folder.
refuses "missing/result.json: cannot be written: its folder" "$bin/m2m_transfer" kuhn:2 kuhn:3 --json "$scratch/missing/result.json"
refuses "--picture $scratch: cannot be written: is a directory" "$bin/m2m_transfer" kuhn:2 kuhn:3 --picture "$scratch"
refuses "--out $scratch: cannot be written: is a directory" "$bin/m2m_transfer" kuhn:2 kuhn:3 --out "$scratch"
study=("$bin/m2m_transfer" --json "$scratch/result.json")
refuses kuhn:x "${study[@]}" kuhn:2,x --study "$scratch/result.exo"
refuses missing.msh "${study[@]}" "kuhn:2,4" "$scratch/missing.msh" --study "$scratch/result.exo"
refuses empty.exo "${study[@]}" kuhn:2,4 kuhn:3 --study "$scratch/empty.exo"
refuses "--out .* does not work with --study" "${transfer[@]}" kuhn:2,4 kuhn:3 --study "$scratch/study"

# A job of several processes prints the error once, and all of them end with 2. (mpirun reports the exit code of the first
# process that failed; --quiet suppresses its own messages.)
job=(timeout 60 "${mpirun[@]}")
refuses missing.exo "${job[@]}" -n 2 "${transfer[@]}" "$scratch/missing.exo" kuhn:2 --pes 2
refuses perhaps "${job[@]}" -n 2 "${transfer[@]}" kuhn:2 kuhn:2 --field 'perhaps(x)' --pes 1
refuses --nonsense "${job[@]}" -n 2 "$bin/hello" --nonsense
refuses --pes "${job[@]}" -n 2 "$bin/embedded" --pes 0
# The exit code of each process.
printf '#!/bin/sh\n"$@"\necho $? >"%s/code.$OMPI_COMM_WORLD_RANK"\n' "$scratch" >"$scratch/keep_code"
chmod +x "$scratch/keep_code"
for fault in "$scratch/missing.exo kuhn:2" "kuhn:2 kuhn:2 --nonsense" "kuhn:2 kuhn:2 --pes 0"; do
  rm -f "$scratch"/code.*
  "${job[@]}" -n 4 "$scratch/keep_code" "${transfer[@]}" $fault \
    >"$scratch/out" 2>"$scratch/err"
  if [[ $(cat "$scratch"/code.[0-3] | tr '\n' ' ') == "2 2 2 2 " && $(wc -l <"$scratch/err") -eq 1 ]]; then
    pass
  else
    fail "four processes, $fault: exit codes $(cat "$scratch"/code.* | tr '\n' ' ')"
    cat "$scratch/err"
  fi
done

# The help is printed once.
for program in hello ring m2m_transfer embedded; do
  if "${job[@]}" -n 2 "$bin/$program" --help >"$scratch/out" 2>"$scratch/err" &&
    [[ $(grep -ci '^usage' "$scratch/out") -eq 1 && ! -s $scratch/err ]]; then
    pass
  else
    fail "two processes, $program --help:"
    cat "$scratch/out" "$scratch/err"
  fi
done

lab=("$bin/lb_lab" --json "$scratch/result.json" --sim pes=4)
replays=("$bin/lb_lab" --sim pes=4)
refuses moving_hot_spot "${lab[@]}" --workload nonsense
refuses greedy_refine "${lab[@]}" --strategy nonsense
refuses --per-pe "${lab[@]}" --per-pe 1,0
refuses "linear_trend; choose another" "${lab[@]}" --strategy gossip --prediction linear_trend
refuses "11 blocks" "$bin/lb_lab" --sim pes=1 --json "$scratch/result.json" --workload stencil --per-pe 12,11
refuses --grain "${lab[@]}" --grain 1
refuses --period "${lab[@]}" --period 6 --iterations 5
refuses "--period: 10 iterations: no round would be held for greedy" "${lab[@]}" --strategy greedy --iterations 10
refuses --when "${lab[@]}" --when sometimes
refuses moving_average "${lab[@]}" --prediction nonsense
refuses --speed "${lab[@]}" --speed 1,1,0.5
refuses --speed "${lab[@]}" --speed 1,1,0.5,0
refuses "--plot .*--replay" "${replays[@]}" --replay "$scratch/empty.exo" --plot "$scratch"
refuses "--json /nowhere/x.json" "${replays[@]}" --replay "$scratch/empty.exo" --json /nowhere/x.json
refuses "--workload .*--replay" "${replays[@]}" --replay "$scratch/empty.exo" --workload linear
refuses "--fold: needs --replay" "${lab[@]}" --fold modulo
refuses missing.json "${replays[@]}" --replay "$scratch/missing.json"
refuses empty.exo "${replays[@]}" --replay "$scratch/empty.exo"
refuses modulo "${replays[@]}" --replay "$scratch/empty.exo" --fold nonsense
refuses --plot "${lab[@]}" --plot "$scratch/empty.exo/plots"
refuses --json "$bin/lb_lab" --sim pes=4 --json "$scratch/missing/result.json"
refuses "greedy is given twice" "${lab[@]}" --strategy greedy,greedy
refuses "4 is given twice" "${lab[@]}" --per-pe 4,8,4
refuses --nonsense "${lab[@]}" --nonsense
refuses --snapshot-format "${lab[@]}" --snapshot-format zip
refuses "3 limits for 4 PEs" "${lab[@]}" --memory-limit 1,2,3

refuses "there is no nonsense; choose of all" "${lab[@]}" --workload all,nonsense
refuses gredy "${lab[@]}" --strategy all,gredy
refuses gredy "${replays[@]}" --replay "$scratch/missing.json" --strategy all,gredy

# Compressed snapshots: truncated, damaged, not compressed, and 67 bytes that unpack to 70 MB.
"$bin/lb_lab" --sim pes=2,cost=1us --strategy greedy --per-pe 4 --iterations 4 --period 2 --save-snapshot "$scratch/saved" >/dev/null || fail "--save-snapshot"
saved=$scratch/saved/linear-4-greedy/data.0.json.br
head -c $(($(stat -c %s "$saved") / 2)) "$saved" >"$scratch/cut.json.br"
refuses "cut.json.br: is truncated" "${replays[@]}" --replay "$scratch/cut.json.br"
{ head -c 40 "$saved"; printf '\xff\xff\xff\xff\xff\xff\xff\xff'; tail -c +49 "$saved"; } >"$scratch/damaged.json.br"
cp "$saved" "$scratch/kept.json.br"
refuses "--json .*kept.json.br would overwrite --replay" "${replays[@]}" --replay "$scratch/kept.json.br" --json "$scratch/./kept.json.br"
refuses "data.0.json.br would overwrite --replay" "${replays[@]}" --replay "${saved%/*}" --json "$saved"
cmp -s "$saved" "$scratch/kept.json.br" && pass || fail "a snapshot that is replayed was overwritten"
refuses "--json .*rows would overwrite --trace" "$bin/lb_lab" --sim pes=4 --json "$scratch/rows" --trace "$scratch/rows"
refuses "--json .*rows would overwrite --trace" "$bin/bench" --pes 1 --json "$scratch/rows" --trace "$scratch/rows" --quick message
refuses "damaged.json.br: " "${replays[@]}" --replay "$scratch/damaged.json.br"
echo '{"phases": []}' >"$scratch/plain.json.br"
refuses "plain.json.br: is damaged, or not compressed" "${replays[@]}" --replay "$scratch/plain.json.br"
cp "$saved" "$scratch/packed.json"
refuses "packed.json: .*end in .br" "${replays[@]}" --replay "$scratch/packed.json"
base64 -d >"$scratch/bomb.json.br" <<<'z///f/glQOKxQCD3/p/////wSwDEYQGA7v0/////4ZcAiMMiAN37f/7//8MvARCHBQC69//518GCXwIgDgsAdCpYAA=='
refuses "bomb.json.br: its 67 bytes unpack to more than 67108864" "${replays[@]}" --replay "$scratch/bomb.json.br"

# Strategies that need positions, where there are none.
echo '{"phases":[{"id":0,"tasks":[{"entity":{"id":7,"home":0,"migratable":true,"type":"object"},"node":0,"time":1.0}]}]}' >"$scratch/nowhere.json"
refuses "--strategy rcb: .*positions.*nowhere.json" "${replays[@]}" --replay "$scratch/nowhere.json" --strategy rcb

# A hexahedron of second order, and a truncated ExodusII file.
printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n$EndNodes\n$Elements\n1\n1 17 2 0 0 1 2 3 4 5 6 7 8 1 2 3 4 5 6 7 8 1 2 3 4\n$EndElements\n' >"$scratch/hex.msh"
refuses "hex.msh: .*hex20" "${transfer[@]}" "$scratch/hex.msh" kuhn:2
"$bin/m2m_transfer" kuhn:4 kuhn:8 --out "$scratch/whole.exo" >/dev/null || fail "whole.exo"
head -c $(($(stat -c %s "$scratch/whole.exo") / 2)) "$scratch/whole.exo" >"$scratch/cut.exo"
refuses "cut.exo: is truncated" "${transfer[@]}" "$scratch/cut.exo" kuhn:2

finish
