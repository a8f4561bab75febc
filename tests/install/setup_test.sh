#!/usr/bin/env bash
# cmake/setup.sh against a pretended apt: what it refuses, what it says, and that it then installs nothing.
set -uo pipefail
setup=$(cd "$(dirname "$0")/../.." && pwd)/cmake/setup.sh
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/bin"
cat >"$scratch/bin/dpkg-query" <<'F'
#!/bin/sh
for last; do :; done
case " $HAVE " in *" all "* | *" $last "*) echo "install ok installed" ;; *) exit 1 ;; esac
F
cat >"$scratch/bin/apt-get" <<'F'
#!/bin/sh
case " $* " in
  *" -s "*)
    for name in $REMOVES; do echo "Remv $name [1.74]"; done
    if [ "$UNKNOWN" = always ] || { [ -n "$UNKNOWN" ] && [ ! -e "$STATE/updated" ]; }; then
      echo "E: Unable to locate package gmsh" >&2
      exit 100
    fi ;;
  *" update "*) touch "$STATE/updated" ;;
  *) echo "$*" >>"$STATE/installed" ;;
esac
F
chmod +x "$scratch"/bin/*

failed=0
# expect NAME CODE WORD INSTALLS ENVIRONMENT… -- ARGUMENTS…
expect() {
  local name=$1 want=$2 word=$3 installs=$4 state=$scratch/$RANDOM
  shift 4
  local environment=()
  while [[ $1 != -- ]]; do
    environment+=("$1")
    shift
  done
  shift
  mkdir "$state"
  local said code=0
  said=$(env HAVE= REMOVES= UNKNOWN= "${environment[@]}" STATE="$state" PATH="$scratch/bin:$PATH" bash "$setup" "$@" 2>&1) || code=$?
  local did=no
  if [[ -e $state/installed ]]; then did=yes; fi
  if ((code == want)) && [[ $said == *"$word"* && $did == "$installs" ]]; then
    echo "ok: $name: ${said##*$'\n'}"
  else
    echo "FAILED: $name: exit code $code (wanted $want), installed: $did (wanted $installs), said: $said"
    failed=1
  fi
}

expect "nothing is missing" 0 "packages are installed" no HAVE=all --
expect "installs what is missing" 0 "setup: done" yes HAVE=g++-12 --
expect "lists are fetched first" 0 "fetching apt's lists" yes UNKNOWN=1 --
expect "a dry run" 0 "would install g++-12" no -- --dry-run
expect "a dry run on a fresh machine" 0 "it would fetch its lists first" no UNKNOWN=1 -- --dry-run
expect "a package is unknown, or there is no network" 2 "E: Unable to locate package gmsh; nothing was changed" no UNKNOWN=always --
expect "Boost would be removed" 2 "apt would remove libboost1.74-dev libcgal-dev" no "REMOVES=libboost1.74-dev libcgal-dev" --
expect "a dry run says so, too" 2 "-DBoost_ROOT" no REMOVES=libboost1.74-dev -- --dry-run
needed=$(sed -n '/^build=(/,/^)/p; /^meshes=(/p; /^tests=(/p' "$setup" | tr '\n()' '   ')
expect "benchmarks' libraries on request" 0 "would install libembree-dev libfcl-dev" no "HAVE=$needed" -- --dry-run --peers
expect "no library of a benchmark otherwise" 0 "packages are installed" no "HAVE=$needed" --
expect "an unknown option" 2 "unknown option --all" no -- --all
exit $failed
