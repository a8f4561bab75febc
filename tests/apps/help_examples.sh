#!/usr/bin/env bash
# help_examples.sh BIN SCENES: every program has --version; larger ones show commands in --help, and each of these runs; a word that is
# mistyped is refused with the one that was meant.
source "$(dirname "$0")/../support/checks.sh"
bin=$(cd "$1" && pwd) scenes=$2
cp "$scenes/bouncy.json" "$scratch"
cd "$scratch" || exit 1
for program in m2m_transfer collide_scene particles lb_lab leanmd task_bench overset amr; do
  n=0
  while read -r name words; do
    n=$((n + 1))
    # shellcheck disable=SC2086
    if [[ $name == "$program" ]] && timeout 100 "$bin/$program" $words >out 2>&1; then
      pass
    else
      fail "$name $words: $(tail -3 out)"
    fi
  done < <("$bin/$program" --help | sed -n '/^Examples:$/,/^$/p' | tail -n +2 | grep .)
  if ((n < 3)); then fail "$program --help shows $n examples"; fi
  # Options of the runtime, of the program, and choices that are mistyped.
  "$bin/$program" --pse 2 >out 2>&1
  if [[ $? -eq 2 && $(<out) == "$program: error: unknown option --pse (did you mean --pes? --help lists the options)" ]]; then pass; else fail "$program --pse: $(<out)"; fi
done

for program in hello ring stencil coupled fsi m2m_transfer m2m_stability overset particles collide_scene leanmd lb_lab task_bench nqueens amr \
  embedded bench bench_balance bench_collide bench_machine bench_dn_field bench_dn_build tess_monitor tutorial_01_hello tutorial_11_race; do
  pattern="^$program \(Tessera\) [0-9]+\.[0-9]+\.[0-9]+, commit [0-9a-z-]+, preset [^,]+, (g|clang)\+\+ [^,]+, (Open MPI|no MPI|MPICH)[^,]*$"
  if "$bin/$program" --version >out 2>&1 && [[ $(wc -l <out) -eq 1 ]] && grep -Eq "$pattern" out; then pass; else fail "$program --version: $(<out)"; fi
done
"${mpirun[@]}" -n 2 "$bin/hello" --version >out 2>&1
if [[ $(wc -l <out) -eq 1 ]]; then pass; else fail "two processes print the version: $(<out)"; fi

# means WORD COMMAND…: exit code 2, and a line that asks for this word.
means() {
  local word=$1
  shift
  "$bin/$1" "${@:2}" >out 2>&1
  if [[ $? -eq 2 && $(wc -l <out) -eq 1 && $(<out) == *"did you mean $word?"* ]]; then pass; else fail "$*: $(<out)"; fi
}
means --fields m2m_transfer kuhn:2 kuhn:2 --feilds x
means linear m2m_transfer kuhn:2 kuhn:2 --kind linaer
means nearest m2m_transfer kuhn:2 kuhn:2 --policy neerest
means rcb m2m_transfer kuhn:2 kuhn:2 --partition rbc
means greedy_refine leanmd --balance greedy-refine
means period leanmd --balance greedy,peroid=5ms
means periodic leanmd --balance greedy,when=peridic
means planes collide_scene plains:64
means voxels collide_scene planes:64 --study voxel
means linear lb_lab --workload liner
means stencil_1d task_bench -type stencil_d1
means compute_bound task_bench -kernel compute-bound
means latency amr --sim pes=2,latancy=2us
means off amr --progress of
sed 's/"step"/"setp"/; s/"steps"/"setps"/' bouncy.json >typed.json
means steps particles typed.json
finish
