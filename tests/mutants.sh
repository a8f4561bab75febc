#!/usr/bin/env bash
# Plants bugs, one at a time, in a copy of the sources, and reports which test catches each. By hand: a minute per bug.
#
#   tests/mutants.sh [TEXT…]     those of which the list's or the bug's name contains one TEXT (all by default)
#
# tests/mutants/*.mutants hold the bugs: a name, the file, the program that should fail, and the lines that are
# replaced (they must occur once):
#
#   == a PE answers a report twice
#   file: runtime/completion/completion.cpp
#   test: test_runtime_parts [completion]
#   - old line
#   + new line
set -euo pipefail
cd "$(dirname "$0")/.."
patterns=("${@:-}")
export CCACHE_DISABLE=1  # together with a precompiled header it returns objects of older sources

copy=build/mutants/source
rm -rf "$copy"
mkdir -p "$copy"
git ls-files -co --exclude-standard | tar -cf - -T - | tar -xf - -C "$copy"
cd "$copy"
cmake --preset release -DCMAKE_UNITY_BUILD=OFF -DCMAKE_CXX_FLAGS_RELEASE=-O1 -DTESS_WARNINGS_AS_ERRORS=OFF ${MUTANTS_CMAKE:-} >/dev/null

n=0
survivors=()
declare -A passes  # without a bug
# chosen NAME: whether it contains one of the patterns.
chosen() {
  local one
  for one in "${patterns[@]}"; do
    if [[ $1 == *"$one"* ]]; then return 0; fi
  done
  return 1
}
# first_failure: the first case, seed or check that the test's log names.
first_failure() {
  awk '
    /^(FAILED protocol_fuzz|protocol_fuzz: repeat with)/ { sub(/^[^:]*: |^FAILED /, ""); print; exit }
    rule { sub(/^ +/, ""); print; exit }
    /^-----/ { rule = 1 }' ../test.log
}
# plant FILE: reads the replaced lines from old and new; exits with 1 unless they occur once.
plant() {
  perl -e '
    sub text { local $/; open(my $in, "<", $_[0]) or die "$_[0]: $!"; return scalar <$in>; }
    my ($file, $old, $new) = map { text($_) } @ARGV;
    my $count = () = $file =~ /\Q$old\E/g;
    exit 1 if $count != 1;
    $file =~ s/\Q$old\E/$new/;
    open(my $out, ">", $ARGV[0]) or die; print $out $file;' "$1" ../old ../new
}
# try NAME FILE TEST…: plants the bug in old and new.
try() {
  local name=$1 file=$2
  shift 2
  if [[ -z ${passes[$*]:-} ]]; then
    cmake --build --preset release -j "$(nproc)" --target "$1" >../build.log 2>&1 ||
      { grep -m 3 "error:" ../build.log; echo "does not compile without a bug: $1"; exit 1; }
    timeout 120 "build/release/bin/$1" "${@:2}" >../test.log 2>&1 || { echo "fails without a bug: $*"; exit 1; }
    passes[$*]=yes
  fi
  cp "$file" ../kept
  if ! plant "$file"; then
    survivors+=("$name (its lines do not occur once in $file)")
    return
  fi
  n=$((n + 1))
  local begin=$SECONDS verdict by=
  if ! cmake --build --preset release -j "$(nproc)" --target "$1" >../build.log 2>&1; then
    verdict="does not compile"
    survivors+=("$name (does not compile)")
  elif timeout 120 "build/release/bin/$1" "${@:2}" >../test.log 2>&1; then
    verdict="survives"
    survivors+=("$name")
  else
    verdict="caught"
    by=$(first_failure)
  fi
  printf '%-16s %-24s %3d s  %s%s\n' "$verdict" "$1" $((SECONDS - begin)) "$name" "${by:+ ($by)}"
  cp ../kept "$file"
}

name=
flush() {
  if [[ -n $name ]] && chosen "$list: $name"; then try "$name" "$file" "${test[@]}"; fi
  name=
}
for list in tests/mutants/*.mutants; do
  while IFS= read -r line || [[ -n $line ]]; do
    case $line in
      "== "*) flush; name=${line#== }; : >../old; : >../new ;;
      "file: "*) file=${line#file: } ;;
      "test: "*) read -ra test <<<"${line#test: }" ;;
      "- "* | "-") printf '%s\n' "${line:2}" >>../old ;;
      "+ "* | "+") printf '%s\n' "${line:2}" >>../new ;;
    esac
  done <"$list"
  flush
done
if ((n + ${#survivors[@]} == 0)); then
  echo "mutants.sh: no bug is named like ${patterns[*]}: see the lists in tests/mutants" >&2
  exit 2
fi
echo "$n bugs planted, ${#survivors[@]} not caught"
for one in ${survivors[@]+"${survivors[@]}"}; do echo "  not caught: $one"; done
((${#survivors[@]} == 0))
