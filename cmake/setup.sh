#!/usr/bin/env bash
# Installs the packages that Tessera builds on, as far as they are missing. Quick when nothing is missing.
#
#   cmake/setup.sh [--dry-run] [--only SET[,SET]] [--peers] [--fuzz] [--with-browser]
#     --dry-run: says what it would do, and does nothing
#     --only: build (compiles the programs), meshes (generates meshes, plots), tests; all three without it
#     --peers: also the libraries beside which benchmarks run
#     --fuzz: also clang's libraries for tests/fuzz/files
#     --with-browser: also Chromium for the test of the page of --monitor, which is skipped otherwise; about 100 MB
#
# Exit code 2, and no package is changed, where apt would remove one, where it does not know one, or where it may not install.
set -euo pipefail

build=(
  g++-12 cmake ninja-build git pkg-config
  openmpi-bin libopenmpi-dev libhwloc-dev libboost1.81-dev
  libfmt-dev nlohmann-json3-dev
  libexodusii-dev libtrilinos-zoltan-dev libscotch-dev libeigen3-dev zlib1g-dev libbrotli-dev
  pybind11-dev python3-dev python3-numpy
)
meshes=(gmsh gnuplot-nox)
tests=(clang-format-16 clang-tidy catch2)
refuse() {
  echo "setup: error: $*" >&2
  exit 2
}

# Nothing else needs these: without them a benchmark leaves their rows out.
peers=(libembree-dev libfcl-dev)
fuzz=(clang-16 libclang-rt-16-dev libfuzzer-16-dev)
dry=false
packages=()
sets=build,meshes,tests
while (($# > 0)); do
  case "$1" in
    --dry-run) dry=true ;;
    --only) sets=${2:-}; shift ;;
    --peers) packages+=("${peers[@]}") ;;
    --fuzz) packages+=("${fuzz[@]}") ;;
    --with-browser) packages+=(chromium) ;;
    --help | -h) sed -n '2,11s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) refuse "unknown option $1: there are --dry-run, --only, --peers, --fuzz and --with-browser" ;;
  esac
  shift
done
IFS=, read -r -a sets <<<"$sets"
for set in "${sets[@]:-}"; do
  case "$set" in
    build) packages+=("${build[@]}") ;;
    meshes) packages+=("${meshes[@]}") ;;
    tests) packages+=("${tests[@]}") ;;
    *) refuse "--only '$set': there are build, meshes and tests" ;;
  esac
done
command -v apt-get >/dev/null || refuse "this script uses apt; install by hand what cmake/setup.sh lists, or the like: ${packages[*]}"

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [[ $status == "install ok installed" ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  echo "setup: all ${#packages[@]} packages are installed"
  exit 0
fi

run=()
if ((EUID != 0)); then
  command -v sudo >/dev/null || refuse "installing ${missing[*]} needs root, and there is no sudo: run cmake/setup.sh as root"
  run=(sudo)
fi
# Names of packages that apt would remove; the list of packages may be old or empty on a new machine.
removed() { apt-get install -s --no-install-recommends "${missing[@]}" 2>/dev/null | awk '$1 == "Remv" { print $2 }'; }
known() { apt-get install -s --no-install-recommends "${missing[@]}" >/dev/null 2>&1; }
first_error() { { apt-get install -s --no-install-recommends "${missing[@]}" 2>&1 || true; } | grep -m 1 '^E:' || echo 'apt gives no reason'; }

if $dry; then
  echo "setup: would install ${missing[*]}${run:+ (with sudo)}"
  known || echo "setup: apt does not know them all yet: it would fetch its lists first"
elif ! known; then
  echo "setup: fetching apt's lists${run:+ (with sudo)}"
  "${run[@]}" apt-get update -qq || true  # what is missing then is found below
fi
lost=$({ removed || true; } | paste -sd ' ' -)
if [[ -n $lost ]]; then
  refuse "apt would remove $lost to install ${missing[*]}; nothing was changed. If that is Boost 1.74's (libboost-dev), keep it: unpack Boost 1.81 or later anywhere, install the others by hand, and configure with -DBoost_ROOT=<its folder>"
fi
if $dry; then exit 0; fi
known || refuse "apt cannot install ${missing[*]}: $(first_error); nothing was changed. Check the network and apt's sources (Debian 12 has all of them)"
echo "setup: installing ${missing[*]}${run:+ (with sudo)}"
DEBIAN_FRONTEND=noninteractive "${run[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
echo "setup: done"
