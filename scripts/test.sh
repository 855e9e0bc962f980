#!/usr/bin/env bash
# Every check of the project, from a fresh clone on: packages, formatting, layers, build without warnings, headers that
# compile alone, sanitizers, clang-tidy, tests. The tests come last, and their summary is the last line printed.
#
#   scripts/test.sh [--tidy none|dd|all]
#
# --tidy   what clang-tidy reads: nothing, dd/ (default), or everything (slow: every file that includes deal.II)
# The exit status is 0 only if every stage passed.
set -euo pipefail

usage() { sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}"; }

tidy='dd'
while (( $# > 0 )); do
  case $1 in
    --tidy) [[ ${2:-} =~ ^(none|dd|all)$ ]] || { usage >&2; exit 2; }; tidy=$2; shift 2 ;;
    -h | --help) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
  esac
done

# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$root"

test_log=build/tests.log
tidy_log=build/tidy.log

# list_files PATTERN...: the files of the repository that match, each followed by a zero byte; without git (an
# unpacked archive) those of the folder.
list_files()
{
  local file pattern tests=(-false)
  if [[ $(git rev-parse --show-toplevel 2>/dev/null) == "$root" ]]; then
    git ls-files -z -- "$@" | while IFS= read -r -d '' file; do
      if [[ -f $file ]]; then printf '%s\0' "$file"; fi
    done
  else
    for pattern in "$@"; do tests+=(-o -path "./$pattern"); done
    find . \( -path ./build -o -path ./results -o -path ./.git \) -prune -o -type f \( "${tests[@]}" \) -printf '%P\0'
  fi
}

check_format()
{
  list_files '*.h' '*.cc' | xargs -0 -r clang-format --dry-run -Werror
}

check_layers()
{
  "$python" scripts/check_layers.py --self-test
  "$python" scripts/check_layers.py
}

build()
{
  cmake --preset ci
  cmake --build --preset ci --parallel "$(compile_jobs)"
}

check_headers()
{
  cmake --build --preset ci --parallel "$(compile_jobs)" \
    --target ddfem_dd_headers ddfem_fem_headers ddfem_coupling_headers
}

# The tests of dd/ under the address and undefined-behaviour sanitizers, shared out over the cores; but for those that only compare
# the bits that different numbers of threads give, or gather statistics: what they run is run by others.
run_sanitizers()
{
  cmake --preset sanitizer
  cmake --build --preset sanitizer --parallel "$n_cores" --target dd_tests
  local shard status=0 shards=()
  for (( shard = 0; shard < n_cores; ++shard )); do
    GTEST_TOTAL_SHARDS=$n_cores GTEST_SHARD_INDEX=$shard OMP_NUM_THREADS=2 OMP_WAIT_POLICY=passive \
      UBSAN_OPTIONS=print_stacktrace=1 build/sanitizer/tests/dd_tests --gtest_brief=1 \
      --gtest_filter='-*NumberOfThreads*:ThermalMotion.*:*BoltzmannDistribution' &
    shards+=($!)
  done
  for shard in "${shards[@]}"; do
    wait "$shard" || status=1
  done
  return $status
}

run_tidy()
{
  local patterns=('dd/*.cc')
  if [[ $tidy == all ]]; then
    patterns+=('fem/*.cc' 'coupling/*.cc')
  fi
  list_files "${patterns[@]}" | xargs -0 -r "$python" scripts/run_tidy.py --jobs "$n_cores" build/ci 2>&1 | tee "$tidy_log"
}

run_tests()
{
  ctest --preset ci --parallel "$n_cores" 2>&1 | tee "$test_log"
}

mkdir -p build
rm -f "$test_log" "$tidy_log"

required_stage packages scripts/install_packages.sh
stage formatting check_format
stage layers check_layers
required_stage build build
stage headers check_headers
stage sanitizers run_sanitizers
if [[ $tidy != none ]]; then
  stage clang-tidy run_tidy
fi
stage tests run_tests

# What was found long ago is out of sight: say it again.
if [[ -s $tidy_log ]]; then
  grep -E '(error|warning): ' "$tidy_log" | sort -u
fi
print_stages
grep -E '^[0-9]+% tests passed' "$test_log" | tail -n 1 || echo "no tests were run"
(( ${#failed_stages[@]} == 0 ))
