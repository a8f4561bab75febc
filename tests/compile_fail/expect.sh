#!/usr/bin/env bash
# expect.sh COMPILER ROOT FILE: the file must not compile, and the sentence after "expect:" must be in an error. Where the
# sentence is the compiler's own, the second line has that of clang after "expect of clang:".
set -uo pipefail
sentence=$(sed -n '1s|^// expect: ||p' "$3")
if "$1" --version | grep -q clang && grep -q '^// expect of clang: ' "$3"; then
  sentence=$(sed -n '2s|^// expect of clang: ||p' "$3")
fi
if [[ -z $sentence ]]; then
  echo "$3 is missing, or its first line names no sentence: // expect: …"
  exit 1
fi
if output=$("$1" -std=gnu++20 -fsyntax-only "-I$2" "$3" 2>&1); then
  echo "$3 compiles, but should not"
  exit 1
fi
if ! grep -E "error: " <<<"$output" | grep -qF -- "$sentence"; then
  echo "$3 does not fail with: $sentence"
  echo "$output" | head -20
  exit 1
fi
