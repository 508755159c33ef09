#!/usr/bin/env bash
# The documentation site, in build/site/html: the READMEs and guides as mkdocs has them (Debian: apt-get install mkdocs).
#   bash apps/site/build.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
rm -rf build/site
mkdir -p build/site/docs
find . -name build -prune -o \( -name '*.md' -o -name '*.svg' -o -name '*.png' \) -exec cp --parents -t build/site/docs {} +
mkdocs build --quiet --config-file apps/site/mkdocs.yml
