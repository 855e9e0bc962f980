# shellcheck shell=bash
# Shared by the scripts of this folder; to be sourced. Paths, environment of MPI runs, timed stages.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
# Debian's interpreter, which has the packages that install_packages.sh installs; another one may come first in PATH.
# shellcheck disable=SC2034 # used by the scripts that source this file
python=/usr/bin/python3
n_cores=$(nproc)

# A translation unit that includes deal.II takes about 1.5 GB of memory: no more of them at once than fit.
compile_jobs()
{
  local kilobytes by_memory
  kilobytes=$(awk '/^MemTotal:/ { print $2 }' /proc/meminfo 2>/dev/null || true)
  by_memory=$(( ${kilobytes:-0} / 1500000 ))
  if (( kilobytes == 0 || by_memory > n_cores )); then
    echo "$n_cores"
  else
    echo $(( by_memory > 1 ? by_memory : 1 ))
  fi
}

# Open MPI: allowed as root (containers), more ranks than cores, threads of a rank not confined to one core, and no
# single-copy transfers, which containers forbid.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_MCA_hwloc_base_binding_policy=none
export OMPI_MCA_btl_vader_single_copy_mechanism=none

if command -v ccache >/dev/null; then
  export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi

stage_lines=()
failed_stages=()

# stage NAME COMMAND...: runs the command from the root of the project, notes its time, and whether it failed in
# failed_stages. Returns 0, so that the caller decides what a failure means.
stage()
{
  local name=$1 begin=$SECONDS status=0 verdict=ok
  shift
  printf '\n==== %s\n' "$name"
  # Not `( ... ) || status=$?`: inside a condition the shell ignores `set -e`.
  set +e
  ( set -euo pipefail; cd "$root"; "$@" )
  status=$?
  set -e
  if (( status != 0 )); then
    verdict="FAILED ($status)"
    failed_stages+=("$name")
  fi
  stage_lines+=("$(printf '%7s min  %-28s %s' "$(minutes $(( SECONDS - begin )))" "$name" "$verdict")")
  printf '==== %s: %s, %s min\n' "$name" "$verdict" "$(minutes $(( SECONDS - begin )))"
}

# required_stage NAME COMMAND...: a stage without which the rest makes no sense.
required_stage()
{
  stage "$@"
  if (( ${#failed_stages[@]} > 0 )) && [[ ${failed_stages[-1]} == "$1" ]]; then
    print_stages
    exit 1
  fi
}

minutes()
{
  awk -v s="$1" 'BEGIN { printf "%.1f", s / 60 }'
}

# The table of times, and which stages failed.
print_stages()
{
  printf '\n'
  printf '%s\n' "${stage_lines[@]}"
  printf '%7s min  total\n' "$(minutes "$SECONDS")"
  if (( ${#failed_stages[@]} > 0 )); then
    printf 'failed: %s\n' "$(IFS=,; echo "${failed_stages[*]}")"
  fi
}
