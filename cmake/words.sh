#!/usr/bin/env bash
# Refuses words that plain English does not need in comments, string literals and READMEs: particles, messages and PEs
# are "it", never a person. `cmake/words.sh [FILE…]` checks these files; without any, the whole project.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ $# -gt 0 ]; then
  files=("$@")
else
  mapfile -t files < <(git ls-files -co --exclude-standard '*.hpp' '*.cpp' '*.md')
fi

awk '
  BEGIN {
    n = split("who whom whoever nobody somebody reckoned", list, " ")
    for (i = 1; i <= n; ++i) banned[list[i]] = 1
  }
  # The text of a line for people: comments and string literals of a source, all of a README but quotations.
  function prose(line,  text, at) {
    if (FILENAME ~ /\.md$/) { gsub(/"[^"]*"|`[^`]*`/, " ", line); return line }
    if (line ~ /^ *#include/) return ""
    text = ""
    while (match(line, /"([^"\\]|\\.)*"|\/\/.*/)) {
      text = text " " substr(line, RSTART, RLENGTH)
      line = substr(line, RSTART + RLENGTH)
    }
    return text
  }
  {
    text = tolower(prose($0))
    gsub(/[^a-z ]/, " ", text)
    n = split(text, words, " ")
    for (i = 1; i <= n; ++i)
      if (words[i] in banned) {
        print FILENAME ":" FNR ": \"" words[i] "\" in: " $0
        failed = 1
      }
  }
  END {
    if (failed) print "words: say it, which, no element, no PE, or name the thing "
    else print "words: plain English"
    exit failed
  }' "${files[@]}"
