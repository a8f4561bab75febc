#!/usr/bin/env bash
# strategy_library.sh BIN LIBRARY: lb_lab and task_bench with strategies of a library that they load.
source "$(dirname "$0")/../support/checks.sh"
bin=$1
library=$2
cd "$scratch" || exit 1
lab=("$bin/lb_lab" --sim pes=2,cost=1us --workload linear --per-pe 4 --iterations 8 --period 2 --grain 100us)

exits 0 "strategies: none, .*, last" "$bin/lb_lab" --list --strategy-library "$library"
exits 0 "best of linear: 4 chares per PE under none" "${lab[@]}" --strategy-library "$library" --strategy last --json lab.json
says "^  none: PEs wait [0-9.]+ % of the time; perfect balance would save [0-9.]+ %; the largest element, lb_lab::Worker\[7\], allows"
says "^linear +4 +last .* 4 +[0-9]+ "  # the four elements of PE 0 move
exits 0 "" "${lab[@]}" --strategy greedy --save-snapshot saved
cp "$library" .
exits 0 "^best of 2 strategies: greedy, max/average" "$bin/lb_lab" --replay saved/linear-4-greedy --strategy greedy,last \
  --strategy-library "$(basename "$library")" --json replay.json
says "^phase [0-9]+ under last: PEs wait 50 % of the time; perfect balance would save 50 %; the largest element, .*, allows"
exits 0 "Balance Rounds 1, 4 columns moved" "$bin/task_bench" --sim pes=2,cost=100ns -width 8 -steps 20 -kernel compute_bound -iter 100 \
  --strategy-library "$library" --balance last --balance-every 10
says "^Limits of trivial: PEs wait [0-9.]+ % of the time"
exits 0 "best of linear" "${mpirun[@]}" -n 2 "$bin/lb_lab" --pes 1 --workload linear --per-pe 2 --iterations 4 --period 2 --grain 10us \
  --strategy-library "$library" --strategy last

loads=("${lab[@]}" --strategy last --strategy-library)
exits 2 "no.so: cannot be loaded" "${loads[@]}" no.so
exits 2 "libm.so.6: does not export" "${loads[@]}" "$(ldd "$bin/lb_lab" | awk '/libm.so/ {print $3}')"
export TESS_TEST_STRATEGIES
for TESS_TEST_STRATEGIES in none:"registers no strategy" version:"another version of Tessera" taken:"greedy: there is a strategy" fails:"strategies.so: no memory of it"; do
  text=${TESS_TEST_STRATEGIES#*:}
  TESS_TEST_STRATEGIES=${TESS_TEST_STRATEGIES%%:*}
  exits 2 "$text" "${loads[@]}" "$library"
done
TESS_TEST_STRATEGIES=short
exits 2 "balance strategy last: returned 7 PEs for 8 elements" "${loads[@]}" "$library"
TESS_TEST_STRATEGIES=boom
for run in "$bin/lb_lab --replay saved/linear-4-greedy --strategy last --strategy-library" "${loads[*]}" \
  "$bin/task_bench --sim pes=2,cost=100ns -steps 20 --balance last --balance-every 10 --strategy-library"; do
  # shellcheck disable=SC2086
  exits 2 "balance strategy last: ends with an exception: boom" $run "$library"
done
exits 2 "no balance strategy 'last'" "${lab[@]}" --strategy last
python3 - <<'END' && pass || fail "the JSON of lb_lab"
import json
lab = json.load(open("lab.json"))
assert all(row["limits"]["sentence"].startswith("PEs wait") for row in lab["results"])
none = lab["results"][0]["limits"]
assert none["largest_element"] == "lb_lab::Worker[7]" and abs(none["balance_share"] - none["wait_share"]) < 0.1
replay = json.load(open("replay.json"))
assert [one["strategy"] for one in replay["strategies"]] == ["greedy", "last"]
END
finish
