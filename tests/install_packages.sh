# The one list of packages, and what installs those that are missing. Source it, then call
#   install_packages "${build_packages[@]}" "${test_packages[@]}"
# As root (or with password-less sudo) it installs; otherwise it names the exact command and fails.

build_packages=(g++ cmake ninja-build ccache
  libceres-dev libeigen3-dev libgoogle-glog-dev libgflags-dev nlohmann-json3-dev libxxhash-dev)
test_packages=(libgtest-dev libbenchmark-dev)

install_packages() {
  if ! command -v dpkg-query >/dev/null; then
    echo "This is no Debian: make sure that these Debian packages' contents are there: $*" >&2
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
      echo "Packages are missing, and installing them needs root. Run this, then try again:" >&2
      echo "  sudo apt-get update && sudo apt-get install --no-install-recommends ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo -n)
  fi
  echo "Installing ${missing[*]}"
  "${as_root[@]}" apt-get update -q >/dev/null
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q --no-install-recommends "${missing[@]}" >/dev/null
}
