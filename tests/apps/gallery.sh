#!/usr/bin/env bash
# gallery.sh BIN SOURCE [keep]: the commands of the gallery's pictures make them. Those that have no times in them are the kept
# ones bit for bit; with `keep` they replace these. The picture of the page of --monitor is made by page.py.
source "$(dirname "$0")/../support/checks.sh"
bin=$1 apps=$2/apps keep=${3:-}

# makes PICTURE COMMAND…: the command writes $scratch/PICTURE's file name, which is the kept picture.
makes() {
  local picture=$1 made
  made=$scratch/$(basename "$1")
  shift
  timeout 200 "$@" >"$scratch/out" 2>&1
  if [[ -n $keep && -s $made ]]; then cp "$made" "$apps/$picture"; fi
  if cmp -s "$made" "$apps/$picture" && (($(stat -c %s "$made") <= 120 * 1024)); then
    pass
  else
    fail "$picture is not what this makes, or above 120 KiB: $*"
    tail -3 "$scratch/out"
  fi
}
knots=("$bin/collide_scene" dragon:1800 dragon:1800 --triangles --move turn:12 --steps 2 --sim pes=4 --out "$scratch/knots")
makes collide_scene/knots.svg "${knots[@]}"
makes collide_scene/knots_owners.svg true
makes overset/after.svg "$bin/overset" kuhn:16 ball:8 --plot "$scratch"
makes overset/before.svg true
makes particles/paths.svg "$bin/particles" "$apps/particles/scenes/shaft_in3_out6.json" --pes 2 --out "$scratch"

# Charts, which gnuplot draws: as many curves as named, and the labels of our style.
if command -v gnuplot >/dev/null; then
  curves() {
    if [[ $(grep -c 'id="gnuplot_plot_' "$1") -eq $2 ]] && ! grep -q 'e[+-]0[0-9]<' "$1"; then pass; else fail "$1 has not $2 curves"; fi
  }
  exits 0 'greedy_refine' "$bin/lb_lab" --sim pes=16,latency=2us,bandwidth=10GB/s,cost=1us --workload moving_hot_spot_comm --per-pe 8 \
    --strategy greedy,greedy_refine,refine --iterations 80 --period 5 --grain 500us --plot "$scratch"
  curves "$scratch/moving_hot_spot_comm-imbalance.svg" 4
  exits 0 'written:' "$bin/m2m_transfer" kuhn:8,16@0.2 --field sin --field gaussian --study "$scratch" --pes 1
  curves "$scratch/error_time.svg" 4
fi
finish
