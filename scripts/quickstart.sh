#!/usr/bin/env bash
# From nothing to a figure: installs the packages, builds the program, runs the micropillar compression, plots it.
#
#   scripts/quickstart.sh [-o DIR]
#
# -o DIR   where the results go (default: results/pillar_compression below the root of the project)
set -euo pipefail

usage() { sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}"; }

output=results/pillar_compression
while (( $# > 0 )); do
  case $1 in
    -o) [[ $# -ge 2 ]] || { usage >&2; exit 2; }; output=$(realpath -m -- "$2"); shift 2 ;;
    -h | --help) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
  esac
done

# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$root"

example=examples/pillar_compression

build_program()
{
  cmake --preset release -DDDFEM_BUILD_TESTS=OFF
  cmake --build --preset release --target ddfem --parallel "$(compile_jobs)"
}

run_example()
{
  export OMP_NUM_THREADS=$n_cores
  build/release/ddfem run "$example/input.prm" -o "$output" --threads "$n_cores"
}

required_stage packages scripts/install_packages.sh --build-only
required_stage build build_program
required_stage run run_example
required_stage plot "$python" "$example/plot.py" "$output"

print_stages
printf '\nresults:  %s\n' "$(realpath -- "$output")"
find "$(realpath -- "$output")" -name '*.png' -printf 'picture:  %p\n' | sort
