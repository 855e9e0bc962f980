#!/usr/bin/env bash
# Installs what ddfem needs from the packages of Debian 12; does nothing where all of it is present.
#
#   scripts/install_packages.sh [--build-only]
#
# --build-only leaves out what only the tests, checks and benchmarks need. Runs as root, or through sudo.
set -euo pipefail

build_packages=(
  cmake ninja-build g++ libopenmpi-dev openmpi-bin libeigen3-dev libhwy-dev libdeal.ii-dev libhdf5-openmpi-dev libcli11-dev
  nlohmann-json3-dev python3 python3-numpy python3-matplotlib
)
test_packages=(git libgtest-dev libbenchmark-dev clang-format clang-tidy)

usage() { sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}"; }

packages=("${build_packages[@]}" "${test_packages[@]}")
case ${1:-} in
  '') ;;
  --build-only) packages=("${build_packages[@]}") ;;
  -h | --help) usage; exit 0 ;;
  *) usage >&2; exit 2 ;;
esac

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  {
    echo "install_packages.sh: this system has no dpkg and apt-get; ddfem is set up on Debian 12 and its derivatives."
    echo "Elsewhere install the equivalents of: ${packages[*]}"
  } >&2
  exit 1
fi

missing=()
for package in "${packages[@]}"; do
  # The status of a package that was never seen is an error of dpkg-query, hence the `|| true`.
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed* ]] || missing+=("$package")
done

if (( ${#missing[@]} == 0 )); then
  echo "all ${#packages[@]} packages are installed"
  exit 0
fi

as_root=()
if (( EUID != 0 )); then
  if ! command -v sudo >/dev/null; then
    {
      echo "install_packages.sh: packages are missing and can only be installed by root. Run as root:"
      echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}"
    } >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "installing: ${missing[*]}"
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300)
"${apt[@]}" update
"${apt[@]}" install -y --no-install-recommends "${missing[@]}"
