#!/bin/bash
# Files compiled for instructions that not every processor has must define no code that the linker
# might take for other files' too: no weak symbols in their objects.
# Usage: shared_code.sh FOLDER, that of the objects of a release.
set -euo pipefail
objects=$(find "$1" -name '*_256.cc.o' -o -name '*_512.cc.o')
if [ -z "$objects" ]; then
  echo "no such objects in $1"
  exit 1
fi
for object in $objects; do
  shared=$(nm -C --defined-only "$object" | awk '$2 ~ /^[WVu]$/')
  if [ -n "$shared" ]; then
    echo "$object defines what other objects may define as well:"
    echo "$shared"
    exit 1
  fi
done
