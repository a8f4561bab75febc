#!/usr/bin/env bash
# Checks every include against layers.txt, and that each arrow and each file there is in use; `--picture` prints houses, rooms, floors and arrows of each module instead.
# A house is a folder of a module with its rooms; no circle runs through houses either.
# `cmake/layers.sh --root ROOT` checks the tree at ROOT, without git.
set -euo pipefail
cd "$(dirname "$0")/.."

sources() { git ls-files -co --exclude-standard 'runtime/*.[hc]pp' 'collide/*.[hc]pp' 'm2m/*.[hc]pp' 'apps/*.[hc]pp' 'tests/*.[hc]pp'; }
if [[ ${1:-} == --root ]]; then
  cd "$2"
  sources() { find runtime collide m2m apps tests -name '*.[hc]pp'; }
  shift 2
fi

sources |
  xargs grep -nE '^#include "(runtime|collide|m2m|apps|tests)/' /dev/null |
  awk -v picture="${1:-}" -v lines="cmake/layers.txt" '
    function room_of(path,  folder) {
      if (path in member) return member[path]
      folder = path
      sub(/\/[^\/]*$/, "", folder)
      return folder
    }
    function refuse(text) { print text; failed = 1 }
    function module_of(room) { sub(/\/.*/, "", room); return room }
    function house_of(room) { return match(room, /^[^\/]*\/[^\/]*/) ? substr(room, 1, RLENGTH) : room }
    BEGIN {
      while ((getline line < lines) > 0) {
        sub(/#.*/, "", line)
        if (line !~ /[^ ]/) continue
        if (split(line, halves, ":") != 2) { refuse(lines ": no ROOM : ROOM… in: " line); continue }
        n = split(halves[1], left, " ")
        if (left[1] in known) refuse(lines ": " left[1] " stands twice")
        for (i = 2; i <= n; ++i) member[left[i]] = left[1]
        n = split(halves[2], right, " ")
        for (i = 1; i <= n; ++i) {
          if (!(right[i] in known)) refuse(lines ": " left[1] " may not stand on " right[i] ", which is no earlier line")
          allowed[left[1], right[i]] = 1
        }
        known[left[1]] = 1
        order[++n_known] = left[1]
      }
    }
    {
      split($0, at, ":")
      target = $0
      sub(/^[^"]*"/, "", target); sub(/".*/, "", target)
      from = room_of(at[1]); to = room_of(target)
      if (module_of(to) == "tests" && module_of(from) != "tests") refuse(at[1] ":" at[2] ": only tests include tests (" target ")")
      if (module_of(from) == "tests") next
      rooms[from] = rooms[to] = 1
      if (from == to) next
      if (!((from, to) in seen)) { seen[from, to] = 1; arrows[from] = arrows[from] " " to }
      if (!(from in known)) { if (!(from in missing)) refuse(at[1] ": " lines " has no line for " from); missing[from] = 1 }
      else if (!((from, to) in allowed)) { ++upward[module_of(from)]; if (!picture) refuse(at[1] ":" at[2] ": " from " may not include " to " (" target ")") }
    }
    END {
      for (key in allowed) {
        split(key, pair, SUBSEP)
        if (!(key in seen) && !picture) refuse(lines ": nothing in " pair[1] " includes " pair[2] ": remove it from its line")
      }
      for (file in member)
        if (system("test -f " file)) refuse(lines ": there is no file " file)
      for (key in seen) {
        split(key, pair, SUBSEP)
        if (module_of(pair[1]) == module_of(pair[2])) ++n_arrows[module_of(pair[1])]
        if (house_of(pair[1]) != house_of(pair[2])) between[house_of(pair[1]), house_of(pair[2])] = 1
      }
      for (k = 1; k <= n_known; ++k) { ++n_rooms[module_of(order[k])]; if (!((h = house_of(order[k])) in floor)) { floor[h] = 1; ++n_houses[module_of(h)] } }
      for (moved = 1; moved;) {  # until each house stands on those that it includes
        moved = 0
        for (key in between) {
          split(key, pair, SUBSEP); h = pair[1]
          if (module_of(pair[2]) != module_of(h) || floor[pair[2]] < floor[h]) continue
          floor[h] = floor[pair[2]] + 1; moved = 1
          if (floor[h] > n_known) { refuse(lines ": a circle runs through the houses " h " and " pair[2]); moved = 0; break }
        }
      }
      for (h in floor) if (floor[h] > top[module_of(h)]) top[module_of(h)] = floor[h]
      if (picture) {
        printf "%-10s %7s %6s %7s %7s %s\n", "module", "houses", "rooms", "floors", "arrows", "not allowed"
        for (module in n_rooms) printf "%-10s %7d %6d %7d %7d %d\n", module, n_houses[module], n_rooms[module], top[module], n_arrows[module], upward[module]
      } else if (!failed) print "layers: every include is allowed, every arrow is used"
      exit failed
    }'
