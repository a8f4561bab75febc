#!/usr/bin/env bash
# The page of a run, drawn by a real browser: page.sh STENCIL CHROMIUM [PICTURE]. Fails unless the page that its script has
# filled shows the chares, a curve, a picture and a heat map. Without a browser (cmake/setup.sh --with-browser) the test
# is skipped: exit code 77. With PICTURE, a .png file, it takes the picture of runtime/guide/see_a_run.md instead, in half a minute:
#
#     tests/runtime/watch/monitor/page.sh build/release/bin/stencil "$(command -v chromium)" runtime/watch/monitor/page.png
set -euo pipefail
stencil=$1 chromium=$2 picture=${3:-}
if [[ ! -x $chromium ]]; then
  echo "skipped: there is no Chromium; cmake/setup.sh --with-browser installs it, then configure again"
  exit 77
fi
scratch=$(mktemp -d)
grid=(--size 256 --blocks 4)
if [[ -n $picture ]]; then grid=(--size 1024 --blocks 8); fi
"$stencil" --pes 2 --monitor 0 "${grid[@]}" --steps 1000000000 >"$scratch/out" 2>"$scratch/lines" &
run=$!
trap 'kill -TERM "$run" 2>/dev/null || true; wait "$run" 2>/dev/null || true; rm -rf "$scratch"' EXIT
for _ in $(seq 100); do
  url=$(grep -o 'http://[0-9.:]*/' "$scratch/lines" || true)
  if [[ -n $url ]]; then break; fi
  sleep 0.1
done
# browse OPTION… URL: a page whose script has come to its end.
browse() {
  timeout 60 "$chromium" --headless --no-sandbox --disable-gpu --virtual-time-budget=2000 --user-data-dir="$scratch/profile" \
    "$@" >"$scratch/page" 2>"$scratch/errors" || { cat "$scratch/errors"; exit 1; }
}
if [[ -n $picture ]]; then
  browse --hide-scrollbars --window-size=1000,1260 --screenshot="$picture" "$url?frames=40&heat=Block"
  if [[ ! -s $picture ]]; then
    echo "FAILED: there is no picture $picture"
    cat "$scratch/errors"
    exit 1
  fi
  exit 0
fi
browse --dump-dom "$url?frames=3&heat=Block"
for want in 'stencil::Block</td><td>16</td>' '<polyline points=' '>temperature</h2><canvas width="256" height="256"' '2 PEs in 1 process' \
  '<canvas id="heat" width="4" height="4"' '>hottest ['; do
  if ! grep -qF "$want" "$scratch/page"; then
    echo "FAILED: the page does not have: $want"
    cat "$scratch/page"
    exit 1
  fi
done
echo "the page shows the run"
