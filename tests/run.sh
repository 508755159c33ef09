#!/usr/bin/env bash
# Installs what is missing, builds the programs and the tests and runs every test; ctest's summary stands last.
# Tests that need the published recordings look in PUSHID_RECORDINGS (default ../shared/fzj_push) and
# count as skipped where there are none. PUSHID_FUZZ_SECONDS=30 runs every fuzz target for so long before.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=tests/install_packages.sh
source tests/install_packages.sh
install_packages "${build_packages[@]}" "${test_packages[@]}"
skip_unusable_ccache

export OPENBLAS_NUM_THREADS=1  # results repeat bit by bit
generator=()
if [ ! -f build/release/CMakeCache.txt ] && command -v ninja >/dev/null; then generator=(-G Ninja); fi
cmake --preset release "${generator[@]}"
cmake --build --preset tests --parallel "$(nproc)"
if [ -f build/release/.ninja_log ]; then python3 tests/studies/build.py log; fi
if [ "${PUSHID_FUZZ_SECONDS:-0}" -gt 0 ]; then bash tests/fuzz/run.sh "$PUSHID_FUZZ_SECONDS"; fi
ctest --preset release --parallel "$(nproc)"
