#!/usr/bin/env bash
# weight.sh [ROOT]: what there is to hold in mind, by module: lines, sources, the fullest folder, public headers and the types that
# they declare outside of `detail`, houses, rooms, floors of houses and arrows of rooms (as layers.sh --picture).
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
cd "${1:-$here/..}"

sources() { git ls-files "$1/*.cpp" "$1/*.hpp"; }

# A header directly in a module, in runtime/core, or directly in collide/dn_field.
public_headers() {
  case $1 in
    runtime) git ls-files 'runtime/*.hpp' | grep -E '^runtime/((core|more)/)?[^/]*$' ;;
    collide) git ls-files 'collide/*.hpp' | grep -E '^collide/(dn_field/)?[^/]*$' ;;
    m2m) git ls-files 'm2m/*.hpp' | grep -E '^m2m/[^/]*$' ;;
  esac
}

public_types() {
  awk '/^namespace .*detail.* *\{/ { hidden = 1 }
       /^}.*namespace .*detail/ { hidden = 0 }
       !hidden && /^(class|struct|enum class|union|concept) [A-Z][A-Za-z0-9]*[^;]*[{:]/ { ++n }
       !hidden && /^(class|struct) [A-Z][A-Za-z0-9]*( final)?$/ { ++n }
       END { print n + 0 }' "$@"
}

printf '%-9s %8s %8s %8s %9s %7s %7s %7s %7s %7s\n' module lines sources fullest headers types houses rooms floors arrows
for module in runtime collide m2m apps tests; do
  mapfile -t files < <(sources "$module")
  lines=$(cat "${files[@]}" | wc -l)
  fullest=$(printf '%s\n' "${files[@]}" | grep '\.cpp$' | sed 's,/[^/]*$,,' | sort | uniq -c | sort -rn | awk 'NR == 1 { print $1 }')
  headers=- types=-
  if [[ $module != apps && $module != tests ]]; then
    mapfile -t public < <(public_headers "$module")
    headers=${#public[@]} types=$(public_types "${public[@]}")
  fi
  read -r houses rooms floors arrows < <(bash "$here/layers.sh" --root "$PWD" --picture 2>/dev/null | awk -v m="$module" '$1 == m { print $2, $3, $4, $5; found = 1 } END { if (!found) print "- - - -" }') || true
  printf '%-9s %8d %8d %8d %9s %7s %7s %7s %7s %7s\n' "$module" "$lines" "${#files[@]}" "$fullest" "$headers" "$types" "$houses" "$rooms" "$floors" "$arrows"
done
