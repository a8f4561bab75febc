#!/usr/bin/env bash
# Checks that all sources are formatted; with --tidy also runs clang-tidy on the given sources, or on those that differ
# from the last commit. `cmake/lint.sh --fix` formats them.
set -euo pipefail
cd "$(dirname "$0")/.."

mapfile -t sources < <(git ls-files -co --exclude-standard '*.hpp' '*.cpp')
case "${1:-}" in
  --fix)
    clang-format -i "${sources[@]}"
    ;;
  --tidy)
    shift
    files=("$@")
    if ((${#files[@]} == 0)); then mapfile -t files < <(git diff --name-only --diff-filter=d HEAD -- '*.cpp'); fi
    if ((${#files[@]} != 0)); then clang-tidy --quiet -p build/release "${files[@]}"; fi
    ;;
  "")
    clang-format --dry-run -Werror "${sources[@]}"
    echo "lint: ${#sources[@]} sources are formatted"
    ;;
  *)
    echo "usage: cmake/lint.sh [--fix | --tidy [FILE…]]" >&2
    exit 2
    ;;
esac
