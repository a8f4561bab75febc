#!/usr/bin/env bash
# Checks that tests mirror the tree: a source with test cases is tests/FOLDER/NAME_test.cpp, where FOLDER holds sources; a
# source without cases (a program, or what cases share) has another name. A public header FOLDER/NAME.hpp has such a source, or
# stands in tests/headers.txt.
# `cmake/test_names.sh [ROOT]` checks the tree at ROOT instead of this one.
set -euo pipefail
cd "${1:-$(dirname "$0")/..}"

failed=0
refuse() {
  echo "$1"
  failed=1
}
while IFS= read -r source; do
  folder=${source%/*}
  if grep -qE '^ *(TEST_CASE|TEMPLATE_TEST_CASE|TEST_CASE_METHOD)\(' "$source"; then
    [[ $source == *_test.cpp ]] || refuse "$source: holds test cases; its name should end in _test.cpp"
    [[ -d ${folder#tests/} ]] || refuse "$source: there is no folder ${folder#tests/} that it could test"
  elif [[ $source == *_test.cpp ]]; then
    refuse "$source: holds no test case; its name should not end in _test.cpp"
  fi
done < <(find tests -name "*.cpp" -not -path "tests/samples/*" | sort)
shopt -s nullglob
excepted=" $(sed '/^#/d' tests/headers.txt | tr '\n' ' ') "
for header in {runtime,runtime/more,collide,collide/dn_field,m2m}/*.hpp; do
  name=${header%.hpp}
  if [[ -f tests/${name}_test.cpp ]]; then
    [[ $excepted != *" $name "* ]] || refuse "tests/headers.txt: $header has a test file"
  elif [[ $excepted != *" $name "* ]]; then
    refuse "$header: no tests/${name}_test.cpp; name in tests/headers.txt where it is tested"
  fi
done
for name in $excepted; do [[ -f $name.hpp ]] || refuse "tests/headers.txt: there is no $name.hpp"; done
if ((failed == 0)); then echo "test_names: tests mirror the tree"; fi
exit $failed
