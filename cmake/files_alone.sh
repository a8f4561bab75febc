#!/usr/bin/env bash
# files_alone.sh PRESET [MOST]: compiles files of the libraries alone (cmake/files_alone): those that commits of the last days
# touch, then one in eight, which the commit chooses; at most MOST. Without MOST all.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=$1 most=${2:-}
folder=build/$preset
if [[ -z $most ]]; then
  cmake --build --preset "$preset" --target files_alone
  exit
fi
# "SOURCE OBJECT" a line; the object of a header names it with __ for /.
mapfile -t all < <(ninja -C "$folder" -t targets all | sed -nE 's#^(cmake/files_alone/CMakeFiles/files_alone\.dir/(__/__/)?(.*)\.cpp\.o): .*#\3 \1#p' |
  awk '{ file = $1; if (!sub(/\.hpp$/, ".hpp", file)) file = file ".cpp"; else gsub(/__/, "/", file); print file, $2 }')
recent=$(git log --since='3 days ago' --name-only --format= 2>/dev/null | sort -u || true)
commit=$(git rev-parse HEAD 2>/dev/null || echo none)
chosen=()
for line in "${all[@]}"; do
  [[ $'\n'$recent$'\n' != *$'\n'"${line% *}"$'\n'* ]] || chosen+=("${line#* }")
done
n_recent=${#chosen[@]}
for line in "${all[@]}"; do
  read -r sum _ < <(cksum <<<"$commit ${line% *}")
  ((sum % 8 != 0)) || chosen+=("${line#* }")
done
((${#chosen[@]} > 0)) || { echo "files_alone: $folder has no such files" >&2; exit 1; }
mapfile -t chosen < <(printf '%s\n' "${chosen[@]}" | awk '!seen[$0]++' | head -n "$most")
echo "files_alone: ${#chosen[@]} of ${#all[@]} files; commits of the last days touch $n_recent"
ninja -C "$folder" --quiet "${chosen[@]}"
