#!/usr/bin/env bash
# Checks that all sources are formatted, written in plain English (words.sh), include what their room may include
# (layers.sh), that programs use the runtime's public functions (internals.sh), that tests mirror the tree (test_names.sh), that
# links of pages lead somewhere (pages.py), and that no script pipes into `grep -q`. `cmake/lint.sh --fix` formats them; `--tidy`
# runs clang-tidy (tidy.sh) on the given sources, or on the runtime's core as far as it changed.
set -euo pipefail
cd "$(dirname "$0")/.."

mapfile -t sources < <(git ls-files -co --exclude-standard '*.hpp' '*.cpp')
case "${1:-}" in
  --fix)
    clang-format-16 -i "${sources[@]}"
    ;;
  --tidy)
    shift
    exec bash cmake/tidy.sh "$@"
    ;;
  "")
    clang-format-16 --dry-run -Werror "${sources[@]}"
    echo "lint: ${#sources[@]} sources are formatted"
    bash cmake/words.sh
    bash cmake/layers.sh
    bash cmake/internals.sh
    bash cmake/test_names.sh
    python3 cmake/pages.py
    # `grep -q` ends at its first match; what still writes to it then fails of a closed pipe, now and then.
    if git grep -nE '[^|][|] *grep +(-[a-zA-Z]+ +)*-[a-zA-Z]*q' -- '*.sh' .ci; then
      echo "lint: give grep -q a file, or write [[ \$(COMMAND) == *TEXT* ]]" >&2
      exit 1
    fi
    ;;
  *)
    echo "usage: cmake/lint.sh [--fix | --tidy [FILE…]]" >&2
    exit 2
    ;;
esac
