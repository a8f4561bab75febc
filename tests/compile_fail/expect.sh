#!/usr/bin/env bash
# expect.sh FILE COMPILER OPTION…: the file must not compile, and the sentence after "expect:" must be in an error. Where the
# sentence is the compiler's own, the second line has that of clang after "expect of clang:".
set -uo pipefail
file=$1
shift
sentence=$(sed -n '1s|^// expect: ||p' "$file")
if [[ $("$1" --version) == *clang* ]] && grep -q '^// expect of clang: ' "$file"; then
  sentence=$(sed -n '2s|^// expect of clang: ||p' "$file")
fi
if [[ -z $sentence ]]; then
  echo "$file is missing, or its first line names no sentence: // expect: …"
  exit 1
fi
if output=$("$@" -fsyntax-only "$file" 2>&1); then
  echo "$file compiles, but should not"
  exit 1
fi
if [[ $(grep "error: " <<<"$output") != *"$sentence"* ]]; then
  echo "$file does not fail with: $sentence"
  echo "$output" | head -20
  exit 1
fi
