#!/usr/bin/env bash
# code_size.sh BUILD: the machine code of a release build stays below limits, since it is what the compiler's time goes into: about
# 0.05 s per KB. A change that exceeds a limit moves code that depends on no type into a source, or says in its commit what for.
set -euo pipefail
cd "$1"
limits=(
  m2m_transfer 5750
  libraries 7200
  tests 21800
  everything 36600
)
# objects NAME: those that the build has.
objects() {
  case $1 in
    m2m_transfer) ninja -t inputs bin/m2m_transfer | grep '\.o$' ;;
    libraries) find runtime collide m2m -name '*.o' ;;
    tests) find tests -name '*.o' ;;
    everything) find runtime collide m2m apps tests -name '*.o' ;;
  esac
}
heavy=0
for ((i = 0; i < ${#limits[@]}; i += 2)); do
  name=${limits[i]} limit=${limits[i + 1]}
  mapfile -t files < <(objects "$name")
  for file in "${files[@]:-none}"; do
    [[ -e $file ]] || { echo "skipped: $name is not built"; exit 77; }
  done
  kilobytes=$(($(size -t "${files[@]}" | tail -n 1 | awk '{ print $1 }') / 1024))
  echo "$name: $kilobytes KB in ${#files[@]} objects, at most $limit"
  ((kilobytes <= limit)) || heavy=1
done
exit $heavy
