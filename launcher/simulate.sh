# Commands that simulate, and that look at what came out.

PICTURES_FAILED=5  # exit code of a run that is whole while a picture of it could not be drawn

# Threads wait actively: waking a sleeping team costs 12 to 25 us a step. They are not bound: a second OpenMP runtime,
# which a linear algebra library brings along, would bind the first thread and leave the engine one core. Memory comes
# in large pages where the system has them: contact looks at places all over it.
set_run_defaults() {
  export OMP_WAIT_POLICY=${OMP_WAIT_POLICY-active} GLIBC_TUNABLES=${GLIBC_TUNABLES-glibc.malloc.hugetlb=1}
}

# A program: the one that PLIANT_ENGINE or PLIANT_REFERENCE names, else the one that is built here.
program() {
  local named=PLIANT_ENGINE
  [ "$1" = pliant_engine ] || named=PLIANT_REFERENCE
  echo "${!named:-$root/build/release/$1}"
}

# What a command needs. Where PLIANT_ENGINE names an engine nothing is installed or built.
need() {  # program or nothing, groups of packages
  if [ -z "${PLIANT_ENGINE-}" ]; then
    ready "${@:2}"
    [ -z "$1" ] || prepare release "$1"
    return
  fi
  PLIANT_ENGINE=$(realpath -m "$PLIANT_ENGINE")  # a study runs it from other folders
  if [ -n "$1" ] && [ ! -x "$(program "$1")" ]; then
    echo "pliant: $(program "$1"): no such program; PLIANT_ENGINE and PLIANT_REFERENCE name those to use, else" \
      "they are built" >&2
    exit 2
  fi
}

draw() {  # folder, or the options of plot.py
  say "drawing ${1-}"
  if [ -n "$quiet" ]; then
    "$python" "$root/scripts/plot.py" "$@" >/dev/null
  else
    "$python" "$root/scripts/plot.py" "$@"
  fi
}

# Runs a command and hands SIGINT and SIGTERM on to it: a run answers them by ending in order. Job control keeps the
# terminal from sending it SIGINT as well, which would be a second one.
forward_signals_to() {
  local pid code=0
  set -m
  "$@" </dev/null &
  pid=$!
  set +m
  trap 'kill -INT $pid 2>/dev/null' INT
  trap 'kill -TERM $pid 2>/dev/null' TERM
  while wait "$pid"; code=$?; kill -0 "$pid" 2>/dev/null; do :; done
  trap - INT TERM
  return "$code"
}

# The run's exit code stays that of the engine: a picture that fails has one of its own (docs/results.md).
pictures_failed() {  # folder
  echo "pliant: the run is complete and its results are whole: $1. Only a picture failed, as said above (exit code" \
    "$PICTURES_FAILED). ./pliant plot ${1@Q} draws them again; --no-plot draws none" >&2
  exit "$PICTURES_FAILED"
}

run_and_draw() {  # program, its arguments, --no-plot (ours): it tells its folder (lib/files/output_folder.hpp)
  local program=$1 argument plot=yes arguments=() told folder code=0
  shift
  for argument in "$@"; do
    case $argument in
      --no-plot) plot=; continue ;;
      --quiet) quiet=yes ;;
    esac
    arguments+=("$argument")
  done
  need "$program"
  told=$(mktemp) || fail "no temporary file can be made"
  export PLIANT_TELL_FOLDER=$told
  forward_signals_to "$(program "$program")" "${arguments[@]}" || code=$?
  folder=$(<"$told")
  rm -f "$told"
  [ "$code" = 0 ] || exit "$code"
  [ -z "$plot" ] || [ -z "$folder" ] || draw "$folder" || pictures_failed "$folder"
}

run() {
  set_run_defaults
  run_and_draw pliant_engine run "$@"
}

reference() { run_and_draw pliant_reference_solver "$@"; }

check() {
  need pliant_engine
  set_run_defaults
  exec "$(program pliant_engine)" check "$@"
}

modes() {
  need pliant_engine
  exec "$(program pliant_engine)" modes "$@"
}

plot() {
  need ""
  draw "$@"
}

movie() {
  need "" movie
  exec "$python" "$root/scripts/movie.py" "$@"
}

shape-functions() {
  need pliant_engine
  "$python" "$root/scripts/shape_functions.py" "$@"
}

view() {
  need ""
  exec "$python" "$root/scripts/view.py" "$@"
}

export_frame() {
  need ""
  exec "$python" "$root/scripts/export.py" "$@"
}

info() {
  need ""
  exec "$python" "$root/scripts/info.py" "$@"
}

compare() {
  need ""
  exec "$python" "$root/scripts/compare.py" "$@"
}

study() {
  need pliant_engine study
  exec "$python" -B -m pliant.study "$@"
}

schema() {
  need pliant_engine
  exec "$(program pliant_engine)" schema
}
