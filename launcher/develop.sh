# Commands for who works on Pliant itself.

read_preset() {  # sets preset, units, scenes and rest
  preset=release units='' scenes='' rest=()
  while [ $# -gt 0 ]; do
    case $1 in
      --preset) preset=${2:-release}; [ $# -lt 2 ] || shift ;;
      --preset=*) preset=${1#*=} ;;
      --units) units=yes ;;
      --scenes) scenes=yes ;;
      *) rest+=("$1") ;;
    esac
    shift
  done
  local known
  known=$(sed -nE 's/^ *"name": "(.*)",?$/\1/p' "$root/CMakePresets.json" | grep -vx base)
  grep -qxF -e "$preset" <<<"$known" && return 0
  echo "pliant: no preset '$preset'; there are:" $known >&2
  exit 2
}

# The thread sanitizer must not judge by what it cannot see in libraries that are not instrumented, libomp first of all;
# libarcher, which libomp loads by itself, tells it about the barriers. The symbolizer names the source lines.
set_sanitizer_defaults() {
  local symbolizer=/usr/lib/llvm-19/bin/llvm-symbolizer
  export TSAN_OPTIONS=${TSAN_OPTIONS-ignore_noninstrumented_modules=1:external_symbolizer_path=$symbolizer}
  export LSAN_OPTIONS=${LSAN_OPTIONS-suppressions=$root/tests/lsan.supp:print_suppressions=0}
}

build_only() {
  local preset units scenes rest
  read_preset "$@"
  [ -z "$units" ] || rest+=(--units)
  [ -z "$scenes" ] || rest+=(--scenes)
  [ ${#rest[@]} = 0 ] || fail "build: unknown option ${rest[0]}; see ./pliant build --help"
  prepare "$preset" all
  say "build/$preset is up to date"
}

# Without the lines of tests that passed; ctest prints the output of those that failed.
without_passed() {
  grep --line-buffered -vE '^ *Start +[0-9]+: |^ *[0-9]+/[0-9]+ Test +#[0-9]+: .* Passed +[0-9.]+ sec *$'
}

count_tests() {  # junit file -> the closing line
  sed -nE '/<testsuite/,/>/ s/.*(tests|failures|skipped|disabled)="([0-9]+)".*/\1 \2/p' "$1" |
    awk '{ n[$1] = $2 }
         END { skipped = n["skipped"] + n["disabled"]
               passed = n["tests"] - n["failures"] - skipped
               printf "%d passed, %d failed, %d skipped\n", passed, n["failures"], skipped }'
}

run_tests() {
  local preset units scenes rest target=all
  read_preset "$@"
  if [ -n "$units" ]; then
    target=pliant_tests rest+=(-L '^unit$')
    ready test
  elif [ -n "$scenes" ]; then
    target=pliant_engine rest+=(-R '^cli\.cases_run$')
    ready test
  else
    ready test verify study movie
  fi
  prepare "$preset" "$target" pliant_tests
  # One more than there are cores: some wait, for clocks and for each other. nproc obeys what is exported below.
  local jobs=$(($(nproc) + 1))
  # Tests run side by side, on one thread each if they ask for no number. Threads must neither be bound to the same
  # cores nor wait actively. The thread sanitizer needs several.
  export OMP_PROC_BIND=${OMP_PROC_BIND-false} OMP_WAIT_POLICY=${OMP_WAIT_POLICY-passive}
  [ "$preset" = tsan ] || export OMP_NUM_THREADS=${OMP_NUM_THREADS-1}
  set_sanitizer_defaults
  local counts="$root/build/$preset/tests.xml"
  rm -f "$counts"
  local folders
  folders=$(sed -n 's/^PLIANT_TEST_FOLDERS:STRING=//p' "$root/build/$preset/CMakeCache.txt" 2>/dev/null)
  [ "${folders:-.*}" = '.*' ] || say "of the unit tests those of $folders"
  say "testing build/$preset"
  ctest --test-dir "$root/build/$preset" -j "$jobs" --output-on-failure --no-tests=error \
    --output-junit "$counts" "${rest[@]}" </dev/null | without_passed
  local code=${PIPESTATUS[0]}
  [ ! -f "$counts" ] || count_tests "$counts"
  return "$code"
}

read_verify_options() {  # sets preset, full and folders
  full='' folders=()
  local argument units scenes rest speed=''
  read_preset "$@"
  if [ "$preset" != release ] && [ -n "${PLIANT_ENGINE:-}" ]; then
    echo "pliant: verify: --preset $preset, and PLIANT_ENGINE names another engine: give one of the two" >&2
    exit 2
  fi
  [ "$preset" != lint ] || rest+=("--preset lint")
  rest+=(${units:+--units} ${scenes:+--scenes})
  for argument in ${rest[@]+"${rest[@]}"}; do
    case $argument in
      --full) full=1; continue ;;
      --fast | --slow) speed=${argument#--}; continue ;;
      --mutate)
        echo "pliant: verify: --mutate comes first: ./pliant verify --mutate [MUTATION...]; see --help" >&2
        exit 2
        ;;
      -*) echo "pliant: verify: unknown option $argument; see ./pliant verify --help" >&2; exit 2 ;;
    esac
    if [[ $argument == */* ]] || [ ! -f "$root/verify/$argument/check_$argument.py" ]; then
      echo "pliant: verify: no case '$argument'; there are:" \
        "$(cd "$root/verify" && echo */check_*.py | sed 's,/[^ ]*,,g')" >&2
      exit 2
    fi
    folders+=("$root/verify/$argument")
  done
  [ ${#folders[@]} -gt 0 ] || mapfile -t folders < <(cases_by_length "${speed:-all}" "$full")
}

cases_by_length() {  # fast, slow or all; 1 if long ones too: folders, by what each CASE says of itself
  local file says speed
  for file in "$root"/verify/*/check_*.py; do
    says=$(grep -m 1 '^CASE = Case(__file__' "$file") speed=slow
    [[ $says == *fast=True* ]] && speed=fast  # tests/CMakeLists.txt takes these for tests
    [[ $says == *long=True* && -z $2 ]] && continue
    [[ $1 != "$speed" && $1 != all ]] || dirname "$file"
  done
}

verify() {
  local preset full folders code=0 interrupted=''
  if [ "${1-}" = --mutate ]; then
    prepare_verification release
    "$python" -B "$root/verify/mutations/mutate.py" "${@:2}" </dev/null || exit $?
    return
  fi
  read_verify_options "$@"
  prepare_verification "$preset"
  local build=$root/build/$preset
  export PLIANT_ENGINE=${PLIANT_ENGINE:-$build/pliant_engine}
  export PLIANT_REFERENCE=${PLIANT_REFERENCE:-$build/pliant_reference_solver}
  set_sanitizer_defaults
  trap 'interrupted=1' INT  # pytest's own code for it is also that of a file which does not load
  PLIANT_VERIFY_FULL=$full OMP_WAIT_POLICY=passive "$python" -B -m pytest -c "$root/verify/pytest.ini" \
    -n "$(nproc)" --dist loadfile "${folders[@]}" </dev/null || code=1
  trap - INT
  [ -z "$interrupted" ] || code=130
  exit "$code"
}

prepare_verification() {  # preset
  ready test verify
  prepare "$1" pliant_engine
  prepare "$1" pliant_reference_solver
  prepare "$1" pliant_agreement pliant_agreement
}

bench() {
  case ${1-} in
    '' | kernels | --benchmark*)
      [ "${1-}" != kernels ] || shift
      ready test
      prepare release pliant_bench pliant_bench
      set_run_defaults
      exec "$root/build/release/pliant_bench" "$@"
      ;;
    scenes)
      prepare release pliant_engine
      exec "$python" -B "$root/benchmarks/scenes.py" "${@:2}"
      ;;
    scaling)
      ready
      prepare release pliant_record_loops pliant_record_loops
      exec "$python" -B "$root/benchmarks/scaling.py" "${@:2}"
      ;;
    partition)
      ready
      exec "$python" -B "$root/benchmarks/partition.py" "${@:2}"
      ;;
    machines)
      ready
      exec "$python" -B "$root/benchmarks/many_machines.py" "${@:2}"
      ;;
    error)
      prepare release pliant_engine
      prepare release pliant_reference_solver
      exec "$python" -B "$root/benchmarks/error.py" "${@:2}"
      ;;
    gate)
      ready test
      prepare counting pliant_engine
      prepare counting pliant_counted_kernels pliant_counted_kernels
      exec "$python" -B "$root/benchmarks/gate.py" "${@:2}"
      ;;
    faults)
      ready test
      prepare counting pliant_counted_kernels pliant_counted_kernels
      prepare release pliant_tests pliant_tests
      exec "$python" -B "$root/benchmarks/injected_faults.py" "${@:2}"
      ;;
    ab)
      ready
      set_run_defaults
      exec "$python" -B "$root/benchmarks/ab.py" "${@:2}"
      ;;
    page)
      ready
      exec "$python" -B "$root/benchmarks/page.py" "${@:2}"
      ;;
    --instructions)
      ready test
      prepare counting pliant_engine
      exec "$python" "$root/benchmarks/marginal_cost.py" "${@:2}"
      ;;
    --reference)
      prepare release pliant_reference_solver
      exec "$python" "$root/benchmarks/reference_cost.py" "${@:2}"
      ;;
    *)
      echo "pliant: bench: nothing is called '$1'; there are: kernels, scenes, scaling, partition, machines," \
        "error, gate, faults, ab, page; see ./pliant bench --help" >&2
      exit 2
      ;;
  esac
}

docs() {
  ready
  exec "$python" -B "$root/scripts/docs.py" "$@"
}

fuzz() {
  prepare fuzz pliant_fuzzers
  exec "$python" -B "$root/tests/fuzz/fuzz.py" "$@"
}

lint() {
  prepare lint build_info
  # Not the two main files and the triangulation: a fifth of the time, for headers of CLI11 and CGAL.
  local files=("$@")
  [ $# -gt 0 ] || mapfile -t files < <(grep -oE '"file": "[^"]*' "$root/build/lint/compile_commands.json" |
    cut -d '"' -f 4 | grep -E 'pliant_(scene|lib|reference)\.dir/Unity/')
  [ $# -gt 0 ] && say "clang-tidy over $# files" || say "clang-tidy over lib/ and reference/"
  printf '%s\0' "${files[@]}" |
    xargs -0 -n 1 -P "$(nproc)" clang-tidy-19 --quiet -p "$root/build/lint" 2>"$root/build/lint.log" ||
    fail "clang-tidy complains; .clang-tidy has the reason of each rule"
  say "clang-tidy has no complaint"
}

format() {
  ready test
  "$root/tests/structure/format.sh" --write
}
