# Building: one call at a time in this checkout, never while a run goes on.

lock() {  # one call at a time in this checkout
  mkdir -p "$root/build" || fail "cannot write to $root/build"
  exec 9>"$root/build/.lock"
  flock -n 9 && return 0
  say "waiting for another pliant in this folder to finish building"
  flock 9
}

unlock() { exec 9>&-; }

show_log_and_fail() {  # log, what failed
  rm -f "$root/build/packages.stamp"  # so that the next call looks for missing packages again
  grep -E -m 1 -A 25 'FAILED:|CMake Error|error:' "$1" >&2 || tail -n 25 "$1" >&2
  fail "$2 failed. Full log: $1"
}

configure() {  # preset, target that is left out without its packages, if any: looked for again once they are installed
  local log="$root/build/$1/configure.log" ninja="$root/build/$1/build.ninja"
  # Of the unit tests, see tests/CMakeLists.txt.
  local folders=${PLIANT_TEST_FOLDERS:+-DPLIANT_TEST_FOLDERS=$PLIANT_TEST_FOLDERS}
  [ -n "$folders" ] || [ ! -f "$ninja" ] || { [ -n "${2-}" ] && ! grep -q "^build $2:" "$ninja"; } || return 0
  mkdir -p "$root/build/$1"
  say "configuring build/$1"
  (cd "$root" && cmake --preset "$1" ${folders:+"$folders"}) >"$log" 2>&1 </dev/null 9>&- ||
    show_log_and_fail "$log" "configuring"
}

announce_build() {  # directory, stamp of the last build: a line before what may take minutes, none before an instant
  local sources=("$root"/{lib,reference,tests,benchmarks,cmake,CMakeLists.txt})
  if [ ! -f "$2" ] || [ -n "$(find "${sources[@]}" -newer "$2" -print -quit 2>/dev/null)" ]; then
    say "building in ${1#"$root"/} (log: ${2%/*}/build.log; the first time takes some minutes)"
  fi
}

build() {  # preset, target, target of which the preset must know
  configure "$1" "${3-}"
  local directory="$root/build/$1"
  local stamp="$directory/built-$2.stamp"
  announce_build "$directory" "$stamp"
  ninja -C "$directory" "$2" >"$directory/build.log" 2>&1 </dev/null 9>&- ||
    show_log_and_fail "$directory/build.log" "building"
  touch "$stamp"
}

prepare() {  # preset, target, target of which the preset must know
  lock
  ensure_packages
  case $1 in tsan | fuzz | lint) install_needed test ;; esac
  build "$1" "$2" "${3-}"
  unlock
}

ready() {  # groups of packages that are needed beside those of every command
  local group
  lock
  ensure_packages
  for group in "$@"; do install_needed "$group"; done
  unlock
}
