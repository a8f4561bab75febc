#!/usr/bin/env bash
# real_meshes.sh BIN DATA [all]: real meshes onto themselves lose no vertex and keep all values bit for bit; for pairs of
# meshes, found + snapped + outside is the number of targets. Without "all" a quick choice; with it every mesh of DATA, and
# every pair of them.
source "$(dirname "$0")/../../support/checks.sh"
bin=$1 data=$2 choice=${3:-quick}

meshes=("$data/nalu/3d_tet4_taylor_green_0p4.exo" "$data/mfem/homology.asc.v41.msh" "$data/mfem/simple-cube-wedge6.e" "$data/skfem/cuubat.msh")
[[ $choice == all ]] && mapfile -t meshes < <(find "$data" -name '*.exo' -o -name '*.e' -o -name '*.msh' | sort)

# asserts FILE PYTHON: the expression holds for the only row of the report, p.
asserts() { python3 -c "import json, sys; p = json.load(open('$1'))['results'][0]; sys.exit(0 if $2 else 1)"; }

# L2 leaves out vertices that no tetrahedron uses: these have no mass.
readable=()
for mesh in "${meshes[@]}"; do
  name=$(basename "$mesh")
  if ! "$bin/m2m_transfer" "$mesh" "$mesh" --field gaussian --chares 7 --pes 2 --json "$scratch/self.json" >"$scratch/out" 2>&1; then
    # A mesh without volume elements, or with solids of an order that is not supported, is refused by name.
    if grep -qE "error: .*$name: " "$scratch/out" && [[ $choice == all ]]; then
      echo "refused: $(cut -c1-150 <"$scratch/out")"
    else
      fail "$name: $(tail -1 "$scratch/out")"
    fi
    continue
  fi
  readable+=("$mesh")
  if asserts "$scratch/self.json" "p['outside'] == 0 and p['snapped'] == 0 and p['l2'] == 0"; then
    pass
  else
    fail "$name onto itself: $(grep -A3 found "$scratch/out")"
  fi
done

pairs=0
for source in "${readable[@]}"; do
  for target in "${readable[@]}"; do
    [[ $source == "$target" ]] && continue
    pairs=$((pairs + 1))
    if "$bin/m2m_transfer" "$source" "$target" --field linear --pes 2 --json "$scratch/pair.json" >"$scratch/out" 2>&1 &&
      asserts "$scratch/pair.json" "p['inside'] + p['boundary'] + p['snapped'] + p['outside'] == p['targets'] and (p['found'] == 0 or p['linf_found'] < 1e-9 * 500)"; then
      pass
    else
      fail "$source -> $target: $(tail -3 "$scratch/out")"
    fi
  done
done
# Side sets of ExodusII and physical groups of gmsh, by name.
cube=("$data/mfem/simple-cube-tet4.e" "$data/mfem/simple-cube-tet10.e")
"$bin/m2m_transfer" "${cube[@]}" --source-part bottom --target-part bottom --kind conservative --field linear --json "$scratch/part.json" >"$scratch/out" 2>&1 &&
  asserts "$scratch/part.json" "p['outside'] == 0 and p['linf_found'] < 1e-12" && pass || fail "bottom: $(tail -1 "$scratch/out")"
"$bin/m2m_transfer" "$data/skfem/box.msh" "$data/skfem/box.msh" --source-part front --target-part front --field gaussian --json "$scratch/part.json" \
  >"$scratch/out" 2>&1 && asserts "$scratch/part.json" "p['outside'] == 0 and p['l2'] == 0" && pass || fail "front: $(tail -1 "$scratch/out")"
"$bin/m2m_transfer" "${cube[@]}" --source-part botom >"$scratch/out" 2>&1
[[ $? -eq 2 && $(wc -l <"$scratch/out") -eq 1 ]] && grep -q "no part 'botom': there are bottom, top (side sets)" "$scratch/out" &&
  pass || fail "botom: $(cat "$scratch/out")"
"$bin/m2m_transfer" "$data/spot/spot.obj" "$data/spot/spot.obj" --kind projection --json "$scratch/part.json" >"$scratch/out" 2>&1 &&
  asserts "$scratch/part.json" "p['boundary'] == p['targets'] == 2930 and p['l2'] == 0" && pass || fail "spot.obj: $(tail -1 "$scratch/out")"

echo "${#readable[@]} meshes onto themselves, $pairs pairs"

finish
