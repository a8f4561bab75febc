#!/usr/bin/env bash
# Runs clang-tidy on the runtime's core, or on the given sources. The core is looked at as the release build compiles it,
# several sources at once, which is five times faster than one by one; and only where its text, or that of a header of ours
# which it includes, changed since it was last clean. What is clean has a stamp in build/tidy/, a hash of all that was read.
set -euo pipefail
cd "$(dirname "$0")/.."

build=build/release
stamps=build/tidy
mkdir -p "$stamps"
[[ -e $build/compile_commands.json ]] || { echo "tidy: there is no $build: cmake --preset release && cmake --build --preset release" >&2; exit 2; }

sources=("$@")
# The core: what every program runs on. The balance strategies and the libraries are checked by name, by hand.
if ((${#sources[@]} == 0)); then
  mapfile -t sources < <(find "$build/runtime" -path '*/Unity/*.cxx' ! -path '*/tess_balance.dir/*' | sort)
fi

# OBJECT FILE… a line: what each object of the release build was made from, as far as it is the project's.
ninja -C "$build" -t deps 2>/dev/null | awk -v root="$PWD/" '
  /^[^ ]/ { if (line != "") print line; line = $1; sub(/:$/, "", line); next }
  NF == 1 {
    file = $1
    # A compiler cache writes paths relative to the build folder.
    if (index(file, root) == 1) file = substr(file, length(root) + 1)
    else if (!sub(/^\.\.\/\.\.\//, "", file)) next
    if (file !~ /^build\//) line = line " " file
  }
  END { if (line != "") print line }' >"$stamps/reads"

# The precompiled headers and the parameters are g++'s; sources include what they need.
sed -E 's/-Winvalid-pch -include [^ ]+//; s/--param=[^ ]+//' "$build/compile_commands.json" >"$stamps/compile_commands.json"

stale=()
for source in "${sources[@]}"; do
  read -r -a reads < <(grep -m 1 "^${source#"$build/"}.o " "$stamps/reads" | cut -d' ' -f2- || echo "$source")
  key=$(cat .clang-tidy "${reads[@]}" 2>/dev/null | sha256sum | cut -d' ' -f1)
  stamp=$stamps/${source//\//__}
  if [[ ! -e $stamp || $(<"$stamp") != "$key" ]]; then stale+=("$source" "$stamp" "$key"); fi
done

check() {
  local out
  if out=$(clang-tidy --quiet -p build/tidy --checks=-bugprone-suspicious-include \
             --extra-arg=-Wno-unknown-warning-option "$1" 2>/dev/null); then
    echo "$3" >"$2"
  else
    printf '%s\n' "$out"
    return 1
  fi
}
export -f check
echo "tidy: $((${#stale[@]} / 3)) of ${#sources[@]} to look at"
((${#stale[@]} == 0)) || printf '%s\n' "${stale[@]}" | xargs -d '\n' -n 3 -P "$(nproc)" bash -c 'check "$@"' check
