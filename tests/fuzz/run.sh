#!/usr/bin/env bash
# Builds the fuzz targets and runs each for some seconds from seeds of the project's own writers:
#   bash tests/fuzz/run.sh [seconds per target, 30] [target ...]
# as many at a time as there are cores, or PUSHID_FUZZ_JOBS of them.
# A crash, a leak, an input that takes over three seconds of processor time or a gigabyte ends the run with exit code 1; the
# input is kept in build/fuzz/findings. What was covered stays in build/fuzz/corpus for the next run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
seconds="${1:-30}"
shift || true
# shellcheck source=tests/install_packages.sh
source tests/install_packages.sh
install_packages "${build_packages[@]}" "${fuzz_packages[@]}"
skip_unusable_ccache
export OPENBLAS_NUM_THREADS=1
generator=()
if [ ! -f build/fuzz/CMakeCache.txt ] && command -v ninja >/dev/null; then generator=(-G Ninja); fi
cmake --preset fuzz "${generator[@]}" >/dev/null
cmake --build --preset fuzz --parallel "$(nproc)"
mkdir -p build/fuzz/findings
build/fuzz/bin/fuzz-seeds build/fuzz/seeds

targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  for source in tests/fuzz/*_fuzz.cc; do targets+=("$(basename "$source" _fuzz.cc)"); done
fi
fuzz() {
  local target="$1" log="build/fuzz/$1.log"
  mkdir -p "build/fuzz/corpus/$target"
  if "build/fuzz/bin/$target-fuzz" "build/fuzz/corpus/$target" "build/fuzz/seeds/$target" \
    -max_total_time="$seconds" -timeout=10 -report_slow_units=10 -rss_limit_mb=1024 -malloc_limit_mb=1024 \
    -max_len=65536 -print_final_stats=1 -artifact_prefix="build/fuzz/findings/$target-" >"$log" 2>&1; then
    echo "$target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") executions, \
$(sed -n 's/^stat::peak_rss_mb: *//p' "$log") MB at most, nothing found"
  elif grep -aq 'run interrupted' "$log"; then
    echo "$target: interrupted, nothing found so far" >&2
    return 1
  else
    echo "$target: FOUND SOMETHING, see $log and build/fuzz/findings" >&2
    grep -aE 'pushid::|^SUMMARY|^Base64' "$log" | head -n 20 >&2
    return 1
  fi
}
export -f fuzz
export seconds
# xargs goes on after a finding, and then fails.
printf '%s\n' "${targets[@]}" | xargs -P "${PUSHID_FUZZ_JOBS:-$(nproc)}" -I{} bash -c 'fuzz {}'
