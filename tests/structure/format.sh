#!/bin/bash
# Every C++ file is written as clang-format-19 writes it (--write: rewrites them). Other versions lay out lambdas among
# arguments and braces in macros differently. Exit code 77, skipped: it is not installed.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."

command -v clang-format-19 >/dev/null || {
  echo "clang-format-19 is not installed: apt-get install clang-format-19"
  exit 77
}
mode=(--dry-run -Werror)
[ "${1-}" != --write ] || mode=(-i)
folders=()
for folder in lib tests reference verify benchmarks; do
  [ ! -d $folder ] || folders+=("$folder")
done
find "${folders[@]}" \( -name '*.hpp' -o -name '*.cpp' \) -print0 | xargs -0 -r clang-format-19 "${mode[@]}" || {
  echo "./pliant format rewrites these files"
  exit 1
}
