#!/usr/bin/env bash
# Installs a build into an empty folder, then configures, builds and runs the consumer project against it; makes the
# Debian packages, and runs a program out of one.
#   consumer_test.sh BUILD
set -euo pipefail
source_dir="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
build="$1"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
cmake --install "$build" --prefix "$scratch/usr" >/dev/null

# Nothing of it may point back at where it was built.
if grep -rlE "$source_dir|$build" "$scratch/usr" --include='*.cmake'; then
  echo "the installed package names the source or build folder" >&2
  exit 1
fi
mv "$scratch/usr" "$scratch/moved"
cmake -S "$source_dir/tests/install/consumer" -B "$scratch/consumer" -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_PREFIX_PATH="$scratch/moved" >/dev/null
cmake --build "$scratch/consumer" >/dev/null
"$scratch/consumer/own_law" "$scratch/study"
"$scratch/consumer/rollout_fit" "${PUSHID_RECORDINGS:-$source_dir/../shared/fzj_push}/manifest.json"

# Programs run from where they were put, and the batch finds those beside it.
"$scratch/moved/bin/pushid-simulate" --out="$scratch/recordings" --people=1 --recordings_per_person=3 >/dev/null
cat >"$scratch/plan.toml" <<END
[data]
recordings = "recordings/manifest.json"
[[variant]]
name = "tail"
[output]
dir = "out"
END
"$scratch/moved/bin/pushid-batch" --plan="$scratch/plan.toml" --quiet | tail -n 1
grep -q ',done,' "$scratch/out/summary.csv"
test -x "$scratch/moved/share/pushid/workflow/profiles/slurm/status.sh"

# `import pushid` from a folder of packages, where the build made it.
import_from() {
  [ -d "$1/pushid" ] || return 0
  PYTHONPATH="$1" PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -c "
import pushid
assert pushid.__file__.startswith('$1'), pushid.__file__
assert pushid.fit(pushid.read('$scratch/recordings/manifest.json')).converged"
  PYTHONPATH="$1" PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -m pushid.ldp --help >/dev/null
}
import_from "$scratch/moved/lib/python3/dist-packages"

if ! command -v dpkg-deb >/dev/null; then exit 0; fi
(cd "$build" && cpack -G DEB -B "$scratch/packages" >/dev/null)
for package in "$scratch"/packages/*.deb; do dpkg-deb -x "$package" "$scratch/unpacked"; done
"$scratch/unpacked/usr/bin/pushid-batch" --version
"$scratch/unpacked/usr/bin/pushid-fit" --recordings="$scratch/recordings/manifest.json" --quiet >/dev/null
find "$scratch/unpacked" -name pushidConfig.cmake | grep -q .
import_from "$scratch/unpacked/usr/lib/python3/dist-packages"
if [ -d "$scratch/moved/lib/python3/dist-packages" ]; then
  dpkg-deb -f "$scratch"/packages/python3-pushid_*.deb Depends | grep -q python3-numpy
fi
