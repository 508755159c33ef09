#!/usr/bin/env bash
# Puts the glossary of parameters that pushid-fit --list_parameters prints into ident/README.md, between the
# lines <!-- parameters --> and <!-- end -->; --print shows it only. No recordings are needed; a second.
# PUSHID_BIN is the folder of the programs (default build/release/bin).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
glossary=$("${PUSHID_BIN:-build/release/bin}/pushid-fit" --list_parameters)
if [ "${1:-}" = --print ]; then printf '%s\n' "$glossary" && exit; fi

readme=ident/README.md
[ "$(grep -c '^<!-- parameters -->$' $readme)" = 1 ] || { echo "$readme: no line <!-- parameters -->" >&2; exit 1; }
new=$(mktemp "$readme.XXXXXX")
trap 'rm -f "$new"' EXIT
GLOSSARY=$glossary awk '
  /^<!-- parameters -->$/ { print; print ENVIRON["GLOSSARY"]; inside = 1; next }
  inside && /^<!-- end -->$/ { inside = 0 }
  !inside { print }
  END { if (inside) print "ident/README.md: no line <!-- end --> after the parameters" >"/dev/stderr"; exit inside }
' $readme >"$new"
cat "$new" >$readme
