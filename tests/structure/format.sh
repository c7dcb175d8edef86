#!/bin/bash
# Every C++ file is written as clang-format-19 writes it (--write: rewrites them). Other versions lay out lambdas among
# arguments and braces in macros differently. Exit code 77, skipped: it is not installed.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."

command -v clang-format-19 >/dev/null || {
  echo "clang-format-19 is not installed: apt-get install clang-format-19"
  exit 77
}
folders=()
for folder in lib tests reference verify benchmarks; do
  [ ! -d $folder ] || folders+=("$folder")
done
mapfile -d '' files < <(find "${folders[@]}" \( -name '*.hpp' -o -name '*.cpp' \) -print0)

if [ "${1-}" = --write ]; then
  clang-format-19 -i "${files[@]}"
else
  clang-format-19 --dry-run -Werror "${files[@]}" 2>&1 | sed -nE 's/^([^:]+:[0-9]+):.*(error|fatal).*/\1/p' |
    sort -V -t: -u -k1,1 | sed 's/$/ is the first line to be laid out otherwise; .\/pliant format does it/' | (! grep .)
fi
