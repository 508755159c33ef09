#!/bin/bash
# Files compiled for instructions that not every processor has must define no code with such
# instructions that the linker might take for other files' too: their weak symbols use no vectors.
# Usage: shared_code.sh FOLDER, that of the objects of a release.
set -euo pipefail
objects=$(find "$1" -name '*_256.cc.o' -o -name '*_512.cc.o')
if [ -z "$objects" ]; then
  echo "no such objects in $1"
  exit 1
fi
for object in $objects; do
  # Eigen has a name of its own there, where it has vectors.
  weak=$(nm --defined-only "$object" | awk '$2 ~ /^[WV]$/ && $3 !~ /8Eigen(256|512)/ {print $3}')
  shared=$(objdump -d --no-show-raw-insn "$object" | awk -v weak="$weak" '
    BEGIN { count = split(weak, names, "\n"); for (i = 1; i <= count; ++i) is_weak[names[i]] = 1 }
    /^[0-9a-f]+ <.*>:$/ { name = $2; gsub(/[<>:]/, "", name) }
    (name in is_weak) && /%[xyz]mm/ { print name; delete is_weak[name] }' | c++filt)
  if [ -n "$shared" ]; then
    echo "$object defines what other objects may define as well:"
    echo "$shared"
    exit 1
  fi
done
