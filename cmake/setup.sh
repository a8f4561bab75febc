#!/usr/bin/env bash
# Installs the packages that Tessera builds on, as far as they are missing. Says what it does; quick when nothing is missing.
set -euo pipefail

packages=(
  g++-12 cmake ninja-build git pkg-config clang-format-16 clang-tidy
  openmpi-bin libopenmpi-dev libhwloc-dev libboost1.81-dev
  libfmt-dev libcli11-dev nlohmann-json3-dev catch2
  libexodusii-dev libtrilinos-zoltan-dev libscotch-dev
  gmsh gnuplot-nox
)

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [[ $status == "install ok installed" ]] || missing+=("$package")
done

if ((${#missing[@]} == 0)); then
  echo "setup: all ${#packages[@]} packages are installed"
  exit 0
fi

echo "setup: installing ${missing[*]}"
run=()
if ((EUID != 0)); then run=(sudo); fi
"${run[@]}" apt-get update -qq
DEBIAN_FRONTEND=noninteractive "${run[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
echo "setup: done"
