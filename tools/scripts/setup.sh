# Shared by tools/run, tools/test, tools/wheel and others: sourced, not run. Brings a Debian 12
# machine (root, or a user with sudo) from nothing to a configured build/release. Speaks on standard
# error only.

set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=tools/$(basename "$0")
build_dir="$root/build/release"
mujoco_dir="$root/.deps/mujoco"
hdf5_dir="$root/.deps/hdf5"

# Of the library and the program, and of their parts (see `build`).
packages=(
  ca-certificates ccache cmake g++ ninja-build python3
  libcli11-dev libeigen3-dev libfmt-dev libqhull-dev libtbb-dev libxsimd-dev nlohmann-json3-dev
)
mjcf_packages=(libtinyxml2-dev python3-pip)
record_packages=(libhdf5-dev zlib1g-dev)
live_packages=(libboost-dev zlib1g-dev)
wheel_packages=(advancecomp python3-dev python3-venv zlib1g-dev)
# Any Node that is there will do: one from elsewhere conflicts with Debian's npm.
viewer_packages=()
[[ -n $(type -P node) && -n $(type -P npm) ]] || viewer_packages=(nodejs npm)
tests_packages=(catch2 chromium libbenchmark-dev pkg-config)
# What the Python package is built and tested with, in an environment of its own.
python_packages=(python3-dev python3-venv)
python_dir="$root/build/python"
# Debian's own where there is one, since python3-dev and python3-venv belong to it.
system_python=/usr/bin/python3
[[ -x $system_python ]] || system_python=python3

say() { printf '%s: %s\n' "$program" "$*" >&2; }
fail() {
  say "error: $*"
  exit 3
}

# install_packages PACKAGE...: those that are missing; touches the network only then.
install_packages() {
  command -v dpkg-query >/dev/null ||
    fail "this is not Debian; install by hand what corresponds to: $*"
  local missing=() installed package
  installed=" $(dpkg-query -W -f '${db:Status-Status}:${Package} ' "$@" 2>/dev/null || true)"
  for package in "$@"; do
    [[ $installed == *" installed:$package "* ]] || missing+=("$package")
  done
  ((${#missing[@]} == 0)) && return
  [[ ${MW_INSTALL_PACKAGES:-ON} != OFF ]] || fail "needs ${missing[*]}, which are not installed"

  local as_root=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null ||
      fail "needs root or sudo to install: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  say "installing ${missing[*]}"
  "${as_root[@]}" apt-get update -qq >&2 || fail "apt-get update failed"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2 ||
    fail "apt-get could not install ${missing[*]}"
}

# MuJoCo reads MJCF files; its headers and library come with its Python wheel.
fetch_mujoco() {
  "$root/tools/scripts/fetch_mujoco.sh" "$mujoco_dir" >&2 ||
    fail "could not fetch MuJoCo from PyPI (MW_MJCF=OFF $program builds without MJCF files)"
}

# The HDF5 that wheels contain. Without leave to install anything they contain the system's.
build_hdf5() {
  [[ ${MW_INSTALL_PACKAGES:-ON} != OFF ]] || return 0
  "$root/tools/scripts/build_hdf5.sh" "$hdf5_dir" >&2 || fail "could not build HDF5 for wheels"
}

# make_python_environment: build/python, with what pyproject.toml's tests want.
make_python_environment() {
  local stamp="$python_dir/made_with" requirements
  mapfile -t requirements < <("$system_python" - "$root/pyproject.toml" <<'END'
import sys, tomllib
project = tomllib.load(open(sys.argv[1], "rb"))["project"]
print(*project["dependencies"], *project["optional-dependencies"]["test"], sep="\n")
END
  )
  ((${#requirements[@]} > 0)) || fail "$system_python could not read pyproject.toml (it needs Python 3.11)"
  if [[ -x $python_dir/bin/python && -f $stamp && $(<"$stamp") == "${requirements[*]}" ]]; then
    return
  fi
  say "making an environment for the Python package in build/python"
  "$system_python" -m venv --clear "$python_dir" >&2 ||
    fail "$system_python could not make build/python"
  "$python_dir/bin/python" -m pip install --quiet --disable-pip-version-check --no-input \
    "${requirements[@]}" >&2 ||
    fail "pip could not install ${requirements[*]} (MW_PYTHON=OFF $program leaves Python out)"
  printf '%s\n' "${requirements[*]}" >"$stamp"
}

# The sets of kernels that there are, and what a CPU needs for them (cmake/Kernels.cmake).
all_kernels=(scalar_f32 scalar_f64 avx2_f32 avx2_f64 avx512_f32)
declare -A needs=(
  [scalar]="" [avx2]="avx2 fma bmi2" [avx512]="avx2 fma bmi2 avx512f avx512vl avx512dq avx512bw"
)
cpu_info=${MW_CPU_INFO:-/proc/cpuinfo}  # another file, for tests

# widest_kernels PRECISION: the widest set that this CPU can run, of those in MW_ISAS where that is set.
widest_kernels() {
  local flags set flag found=""
  flags=" $(sed -n '/^flags/{s/.*://p;q}' "$cpu_info" 2>/dev/null) "
  for set in "${all_kernels[@]}"; do
    [[ $set == *_$1 ]] && is_wanted "${set%_*}" || continue
    for flag in ${needs[${set%_*}]}; do [[ $flags == *" $flag "* ]] || continue 2; done
    found=$set
  done
  echo "$found"
}

# is_wanted ISA: whether MW_ISAS, where that is set, names it.
is_wanted() { [[ -z ${MW_ISAS-} || ";$MW_ISAS;" == *";$1;"* ]]; }

# has PART: whether it is among $parts.
has() { [[ " ${parts[*]} " == *" $1 "* ]]; }
on_off() { if has "$1"; then echo ON; else echo OFF; fi; }

# add_parts PART...: to $parts: what was asked for now, what build/release has had before, and what
# the environment says. A build never loses a part again that it was not told to leave out.
add_parts() {
  local part set known=()
  [[ ! -f $build_dir/parts ]] || read -ra known <"$build_dir/parts" || true
  parts=()
  for part in "$@" "${known[@]}"; do
    if [[ $part == kernels ]]; then
      for set in "${all_kernels[@]}"; do has "$set" || parts+=("$set"); done
    elif ! has "$part"; then
      parts+=("$part")
    fi
  done
  for part in mjcf record live python viewer wheel; do
    local name=MW_${part^^}
    case ${!name-} in
      "") ;;
      ON) has "$part" || parts+=("$part") ;;
      OFF)
        local kept=()
        for set in "${parts[@]}"; do [[ $set == "$part" ]] || kept+=("$set"); done
        parts=("${kept[@]}")
        ;;
      *) fail "$name is '${!name}', must be ON or OFF" ;;
    esac
  done
}

# Configures build/release when it was not, or when the presets or its parts changed. Ninja itself
# reconfigures when a CMake file or the list of sources changed.
configure() {
  local arguments=(--preset release -D MW_UNITY=ON -D "MW_MUJOCO_DIR=$mujoco_dir") set kernels=()
  for set in "${all_kernels[@]}"; do
    if has "$set" && is_wanted "${set%_*}"; then kernels+=("$set"); fi
  done
  ((${#kernels[@]} < ${#all_kernels[@]})) || kernels=()
  arguments+=(-D "MW_KERNELS=$(IFS=';'; echo "${kernels[*]}")")
  arguments+=(-D "MW_MJCF=$(on_off mjcf)" -D "MW_RECORD=$(on_off record)" -D "MW_LIVE=$(on_off live)")
  arguments+=(-D "MW_REPORT=$(on_off report)" -D "MW_PYTHON=$(on_off python)")
  arguments+=(-D "MW_VIEWER=$(on_off viewer)" -D "MW_WHEEL=$(on_off wheel)")
  if has wheel && [[ -e $hdf5_dir/version ]]; then arguments+=(-D "MW_HDF5_DIR=$hdf5_dir"); fi
  arguments+=(-D "MW_TESTS=$(on_off tests)" -D "MW_BENCH=$(on_off tests)")
  if has python; then arguments+=(-D "Python_EXECUTABLE=$python_dir/bin/python"); fi
  if [[ -n ${MW_ISAS-} ]]; then arguments+=(-D "MW_ISAS=$MW_ISAS"); else arguments+=(-U MW_ISAS); fi
  arguments+=(-D "BUILD_SHARED_LIBS=${BUILD_SHARED_LIBS:-OFF}")
  local stamp="$build_dir/configured_with"
  # pip's own cmake is gone after its build.
  local cmake
  cmake=$(sed -n 's/^CMAKE_COMMAND:INTERNAL=//p' "$build_dir/CMakeCache.txt" 2>/dev/null || true)
  if [[ -x $cmake && -f $build_dir/build.ninja && $stamp -nt $root/CMakePresets.json &&
    $(<"$stamp") == "${arguments[*]}" ]]; then
    return
  fi
  say "configuring build/release: ${parts[*]}"
  local log
  log=$(cd "$root" && cmake "${arguments[@]}" 2>&1) || {
    printf '%s\n' "$log" >&2
    fail "cmake could not configure build/release"
  }
  printf '%s\n' "${arguments[*]}" >"$stamp"
  printf '%s\n' "${parts[*]/#wheel/}" >"$build_dir/parts"  # which no other command needs again
}

# Seconds since the epoch, with a fraction, and `took NAME SINCE`: a share of $spent, such as "compile
# 92 s", when it was a second or more. Where .ci/run names a file in MW_TIMES, a line in that, too.
now() { printf '%s' "${EPOCHREALTIME/,/.}"; }
spent=()
took() {
  local seconds
  [[ -z ${MW_TIMES-} ]] || printf '%s\t%s\t%s\n' "$1" "$2" "$(now)" >>"$MW_TIMES"
  seconds=$(awk -v a="$2" -v b="$(now)" 'BEGIN { printf "%.0f", b - a }')
  ((seconds < 1)) || spent+=("$1 $seconds s")
}

# build TARGET PART...: everything up to an up-to-date TARGET in build/release, with these parts of
# it: kernels (all sets) or single ones of $all_kernels, mjcf, record, live, report, tests, python, viewer, wheel. Parts
# share their objects with what was built before, so a build that grows compiles what is new. Two at a
# time wait for one another. MW_MJCF, MW_RECORD, MW_LIVE, MW_PYTHON and MW_VIEWER in the environment (ON or OFF) overrule,
# MW_ISAS="scalar;avx2" leaves out the kernels of other instruction sets, BUILD_SHARED_LIBS=ON links anew.
build() {
  local target=$1 parts=() part since
  shift
  mkdir -p "$root/build"
  exec 9>"$root/build/release.lock"
  flock 9
  add_parts "$@"
  since=$(now)
  for part in mjcf record live tests python viewer wheel; do
    local -n more=${part}_packages
    [[ $part != wheel || ${MW_INSTALL_PACKAGES:-ON} != OFF ]] || continue  # pip install . needs none of them
    if has "$part"; then packages+=("${more[@]}"); fi
  done
  install_packages "${packages[@]}"
  if has mjcf; then fetch_mujoco; fi
  if has wheel && has record; then build_hdf5; fi
  if has python; then make_python_environment; fi
  took packages "$since"
  since=$(now)
  configure
  took configure "$since"
  since=$(now)
  python3 "$root/tools/scripts/progress.py" "$program" "$build_dir" "$target" 9>&- || fail "the build failed"
  took compile "$since"
  exec 9>&-
}
