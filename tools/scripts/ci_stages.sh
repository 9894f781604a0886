# Runs and times the stages of .ci/run: sourced, not run.

report=$PWD/build/ci  # what the stages leave: times, ctest's and pytest's JUnit files
release_isas=
ctest_prefix=()

now() { printf '%s' "${EPOCHREALTIME/,/.}"; }

# timed PHASE COMMAND...: adds the seconds of COMMAND to a phase of the stage: setup, build or run.
timed() {
  local phase=$1 since status=0
  since=$(now)
  shift
  "$@" || status=$?
  printf '%s\t%s\t%s\n' "$phase" "$since" "$(now)" >>"$MW_TIMES"
  return $status
}

# on_release COMMAND...: with the instruction sets that this machine's build/release has.
on_release() { MW_ISAS=$release_isas "$@"; }

# preset NAME OPTION...: configures, builds and tests a preset; the options are CMake's.
preset() {
  timed setup cmake --preset "$@"
  timed build cmake --build --preset "$1" --parallel "$(nproc)"
  timed run "${ctest_prefix[@]}" ctest --preset "$1" --parallel "$(nproc)" --output-junit "$report/$1.xml"
}

# run_stages NAME...: each in a subshell that stops at its first failure.
run_stages() {
  local name since status left_out=""
  read -ra names <<<"$*"
  for name in "${names[@]}"; do
    declare -F "stage_$name" >/dev/null || {
      echo "there is no stage '$name'; stages: $(declare -F | sed -n 's/^declare -f stage_//p' | xargs)" >&2
      exit 2
    }
  done
  rm -rf "$report"
  mkdir -p "$report"
  for name in "${names[@]}"; do
    printf '\n== %s (%d s since the start)\n' "$name" "$SECONDS"
    export MW_TIMES=$report/$name.times PYTEST_ADDOPTS=--junitxml=$report/$name-python.xml
    since=$(now)
    (set -e; "stage_$name")
    status=$?
    printf '%s\t%d\t%s\t%s\n' "$name" "$status" "$since" "$(now)" >>"$report/stages"
  done
  unset PYTEST_ADDOPTS
  python3 tools/scripts/ci_table.py "$report" || exit 1
  note_pass "${names[*]}"
}

# note_pass STAGES: which tree passed all stages, when the checkout has no changes of its own.
note_pass() {
  local folder=${XDG_CACHE_HOME:-$HOME/.cache}/manyworlds
  local all
  all=$(declare -F | sed -n 's/^declare -f stage_//p' | sort | xargs)
  [[ $(tr ' ' '\n' <<<"$1" | sort | xargs) == "$all" ]] || return 0
  if [[ -n $(git status --porcelain) ]]; then
    echo "there are changes that are not committed, so no tree is noted as passed"
    return 0
  fi
  mkdir -p "$folder" && git rev-parse 'HEAD^{tree}' >>"$folder/ci_passed"
}
