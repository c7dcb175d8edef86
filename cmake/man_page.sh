#!/bin/sh
# A help text of the launcher as a man page: man_page.sh HELP2MAN TEXT VERSION PAGE
set -eu
name=$(basename "$4" .1)
folder=$4.d  # beside the page: programs may not run from /tmp
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder"
# help2man asks a program. Its usage is one line and begins with "Usage:".
summary=$(sed -n "s,^  \./pliant ${name#pliant-} .*   *,,p" "$(dirname "$2")/pliant.txt")
{
  echo '#!/bin/sh'
  echo "[ \"\$1\" != --version ] || { echo '$name $3'; exit; }"
  echo "cat <<'TEXT'"
  case $(head -n 1 "$2") in
    ./pliant*) sed '1s/^/Usage: /; s,\./pliant,pliant,g' "$2" | sed -E ':a; N; $!ba; s/\n +(\[|\|)/ \1/g' ;;
    *) sed 's,\./pliant,pliant,g' "$2" ;;
  esac
  echo TEXT
} >"$folder/$name"
chmod +x "$folder/$name"
"$1" --no-info --section 1 --name "${summary:-rigid and compliant grains in one simulation}" --output "$4" "$folder/$name"
