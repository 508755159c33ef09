# shellcheck shell=bash disable=SC2034
# The one list of packages, and what installs those that are missing. Source it, then call
#   install_packages "${build_packages[@]}" "${test_packages[@]}"
# As root (or with password-less sudo) it installs; otherwise it names the exact command and fails.

build_packages=(g++ cmake ninja-build ccache
  libceres-dev libeigen3-dev libgoogle-glog-dev libgflags-dev nlohmann-json3-dev libtomlplusplus-dev
  libxxhash-dev)
# LibTorch trains restorations and generators, with OpenBLAS in half the time; everything else builds and
# runs without them.
test_packages=(libgtest-dev libbenchmark-dev libtorch-dev libopenblas0-pthread chromium
  python3 python3-dev pybind11-dev python3-numpy python3-yaml python3-pytest python3-matplotlib python3-jsonschema
  python3-venv python3-pip python3-setuptools python3-wheel)
fuzz_packages=(clang libclang-rt-14-dev)  # tests/fuzz/run.sh alone needs them
# The workflow's tests are skipped without them: Snakemake takes 44 s and 683 MB to install.
workflow_packages=(snakemake slurmctld slurmd slurm-client munge)

study_packages=(python3-torch)  # tests/studies/peers.py alone needs it; it is skipped without

package_packages=(dpkg-dev)  # cpack: Debian packages, apps/packaging/Containerfile

install_packages() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "This is no Debian, so nothing is installed. Needed are a C++17 compiler, CMake 3.23, Ceres" >&2
    echo "Solver 2.1, Eigen 3.4, glog, gflags, nlohmann-json and xxHash; to train restorations LibTorch; for the" >&2
    echo "tests GoogleTest and Google Benchmark (Debian's names: $*)." >&2
    return 0
  fi
  local missing=() package
  for package in "$@"; do
    if [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)" != installed ]; then
      missing+=("$package")
    fi
  done
  [ ${#missing[@]} -eq 0 ] && return 0

  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! sudo -n true 2>/dev/null; then
      echo "Packages are missing, and installing them needs root. Run this as root, then try again:" >&2
      echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo -n)
  fi
  echo "Installing ${missing[*]}"
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=120)
  # An outdated list of one source need not matter; a failed installation does.
  "${apt[@]}" update >/dev/null </dev/null || echo "apt-get update failed; trying without" >&2
  if ! "${apt[@]}" install -y --no-install-recommends "${missing[@]}" >/dev/null </dev/null; then
    echo "Installing failed. Look what this says, then try again:" >&2
    echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
    return 1
  fi
}

# ccache fails, and the build with it, where its folder cannot be written (no home, a read-only one):
# then do without.
skip_unusable_ccache() {
  local folder
  if folder=$(ccache --get-config cache_dir 2>/dev/null) &&
    mkdir -p "$folder/tmp" 2>/dev/null && [ -w "$folder" ] && [ -w "$folder/tmp" ]; then
    return 0
  fi
  export CCACHE_DISABLE=1
}
