#!/usr/bin/env bash
# on_ranks.sh BIN: m2m_transfer on two ranks. Parts of a .pvtu and weights are those of one process, and a damaged mesh ends
# every rank within seconds, with one line and exit code 2.
source "$(dirname "$0")/../../support/checks.sh"
source "$(dirname "$0")/../box_mesh.sh"
transfer=$1/m2m_transfer
ranks=("${mpirun[@]}" -n 2 "$transfer")
limit=20

# Each chare writes its own file, wherever it is.
meshes=(kuhn:4 kuhn:5@0.2 --field sin --chares 5 --pes 2)
mkdir "$scratch/one" "$scratch/two"
exits 0 result "$transfer" "${meshes[@]}" --out "$scratch/one/r.pvtu"
exits 0 result "${ranks[@]}" "${meshes[@]}" --out "$scratch/two/r.pvtu"
[[ $(cd "$scratch/two" && echo r*) == "r.0.vtu r.1.vtu r.2.vtu r.3.vtu r.4.vtu r.pvtu" ]] || fail "two ranks write $(ls "$scratch/two")"
diff -r "$scratch/one" "$scratch/two" && pass || fail "the parts of two ranks differ from those of one process"
exits 2 "missing/r.pvtu" "${ranks[@]}" "${meshes[@]}" --out "$scratch/missing/r.pvtu"

# Weights that two ranks write and apply give the values of the transfer.
meshes=(kuhn:4 kuhn:5@0.2 --pes 1)
exits 0 result "$transfer" "${meshes[@]}"
hash=$(awk '$1 == "result" { print $2 }' "$scratch/out")
[[ -n $hash ]] || fail "no result"
exits 0 "$hash" "${ranks[@]}" "${meshes[@]}" --weights "$scratch/two.nc"
exits 0 "$hash" "$transfer" "${meshes[@]}" --weights "$scratch/one.nc"
cmp "$scratch/one.nc" "$scratch/two.nc" && pass || fail "the weights of two ranks differ from those of one process"
exits 0 "$hash" "${ranks[@]}" "${meshes[@]}" --from-weights "$scratch/two.nc"
head -c 2000 "$scratch/two.nc" >"$scratch/cut.nc"
exits 2 "cut.nc: " "${ranks[@]}" "${meshes[@]}" --from-weights "$scratch/cut.nc"
exits 2 "two.nc: " "${ranks[@]}" kuhn:4 kuhn:6 --pes 1 --from-weights "$scratch/two.nc"

# damage OUT VARIABLE POSITION BYTES: a copy of good.exo, where an entry (from the end, if negative) of a variable is
# replaced by bytes in hexadecimal.
damage() {
  python3 - "$scratch/good.exo" "$scratch/$1" "${@:2}" <<'PYTHON'
import struct, sys
source, target, name, position, new = sys.argv[1:]
data, new = bytearray(open(source, "rb").read()), bytes.fromhex(new)
number = lambda at, form=">I": struct.unpack_from(form, data, at)[0]
padded = lambda n: (n + 3) // 4 * 4
# NetCDF-3 with offsets of 64 bits: name, dimensions, attributes, type, size, offset.
assert data[:4] == b"CDF\2"
at = data.index(struct.pack(">I", len(name)) + name.encode() + bytes(padded(len(name)) - len(name)), data.index(b"\0\0\0\x0b"))
at += 4 + padded(len(name))
at += 4 + 4 * number(at)
n_attributes = number(at + 4)
at += 8
for _ in range(n_attributes):
    at += 4 + padded(number(at))
    size = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8}[number(at)]
    at += 8 + padded(size * number(at + 4))
n, begin = number(at + 4) // len(new), number(at + 8, ">Q")
place = begin + int(position) % n * len(new)
assert data[place:place + len(new)] != new
data[place:place + len(new)] = new
open(target, "wb").write(data)
PYTHON
}
nan=7ff8000000000000
exits 0 result "$transfer" kuhn:2 kuhn:5@0.2 --out "$scratch/good.exo"
exits 0 "0 outside" "${ranks[@]}" "$scratch/good.exo" "$scratch/good.exo" --pes 1
head -c 3000 "$scratch/good.exo" >"$scratch/cut_header.exo"
head -c -20 "$scratch/good.exo" >"$scratch/cut_end.exo"
damage nan_first.exo coordx 0 $nan
damage nan_last.exo coordz -1 $nan
damage corner_first.exo connect1 0 00000000  # counted from 1
damage corner_last.exo connect1 -1 7fffffff
damage corner_next.exo connect1 -2 000000d9  # of 216 vertices
# Text is read by one PE, which sends the ranges.
box "$scratch/good.msh" 1 0
sed '10s/ [^ ]*$/ nan/' "$scratch/good.msh" >"$scratch/nan.msh"
sed 's/^162 .*/162 4 0 1 2 3 999/' "$scratch/good.msh" >"$scratch/corner.msh"
head -c 2000 "$scratch/good.msh" >"$scratch/cut.msh"
exits 0 "0 outside" "${ranks[@]}" "$scratch/good.msh" "$scratch/good.msh" --pes 1

for name in cut_header.exo cut_end.exo nan_first.exo nan_last.exo corner_first.exo corner_last.exo corner_next.exo nan.msh \
  corner.msh cut.msh; do
  case $name in
    nan*) text="$name: vertex [0-9]* has [xyz] = nan" ;;
    corner*) text="$name: .*\(2147483646\|-1\|216\|999\)" ;;
    *) text="$name: .*\(truncated\|ends\)" ;;
  esac
  exits 2 "$text" "${ranks[@]}" "$scratch/$name" kuhn:3 --pes 1
  exits 2 "$text" "${ranks[@]}" kuhn:3 "$scratch/$name" --pes 2
done
finish
