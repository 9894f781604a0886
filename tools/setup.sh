# Shared by tools/run, tools/test and tools/emulate_avx512: sourced, not run. Brings a Debian 12
# machine (root, or a user with sudo) from nothing to a configured build/release. Speaks on standard
# error only.

set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=tools/$(basename "$0")
build_dir="$root/build/release"
mujoco_dir="$root/.deps/mujoco"

packages=(
  ca-certificates cmake g++ ninja-build python3 python3-pip
  catch2 libbenchmark-dev libcli11-dev libeigen3-dev libfmt-dev libhdf5-dev libqhull-dev libtbb-dev
  libxsimd-dev nlohmann-json3-dev
)
# What the Python package is built and tested with, in an environment of its own.
python_packages=(python3-dev python3-venv)
python_dir="$root/build/python"
# Debian's own where there is one, since that is whom python3-dev and python3-venv belong to.
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
  "$root/tools/fetch_mujoco.sh" "$mujoco_dir" >&2 ||
    fail "could not fetch MuJoCo from PyPI (MW_MJCF=OFF $program builds without MJCF files)"
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
  ((${#requirements[@]} > 0)) || fail "$system_python could not read pyproject.toml (it wants Python 3.11)"
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

# Configures build/release when it was not, or when the presets changed. Ninja itself reconfigures
# when a CMake file or the list of sources changed.
configure() {
  local mjcf=$1 record=$2 python=$3
  local arguments=(--preset release -D "MW_MJCF=$mjcf" -D "MW_MUJOCO_DIR=$mujoco_dir"
    -D "MW_RECORD=$record" -D "MW_PYTHON=$python")
  [[ $python == OFF ]] || arguments+=(-D "Python_EXECUTABLE=$python_dir/bin/python")
  if [[ -n ${MW_ISAS-} ]]; then arguments+=(-D "MW_ISAS=$MW_ISAS"); else arguments+=(-U MW_ISAS); fi
  local stamp="$build_dir/configured_with"
  if [[ -f $build_dir/build.ninja && $stamp -nt $root/CMakePresets.json &&
    $(<"$stamp") == "${arguments[*]}" ]]; then
    return
  fi
  say "configuring build/release"
  (cd "$root" && cmake "${arguments[@]}" >&2) || fail "cmake could not configure build/release"
  printf '%s\n' "${arguments[*]}" >"$stamp"
}

# configured_python: ON when build/release was last configured with the Python package, else OFF.
configured_python() {
  if [[ -f $build_dir/configured_with && $(<"$build_dir/configured_with") == *MW_PYTHON=ON* ]]; then
    echo ON
  else
    echo OFF
  fi
}

# build TARGET: everything up to an up-to-date TARGET in build/release. Two at a time wait for one
# another. MW_MJCF=OFF, MW_RECORD=OFF, MW_PYTHON=OFF and MW_ISAS="scalar;avx2", in the environment,
# leave things out. The Python package is only configured by who says so (MW_PYTHON=ON, tools/test).
build() {
  local target=$1 mjcf=${MW_MJCF:-ON} record=${MW_RECORD:-ON} python=${MW_PYTHON:-}
  [[ $mjcf == ON || $mjcf == OFF ]] || fail "MW_MJCF is '$mjcf', must be ON or OFF"
  [[ $record == ON || $record == OFF ]] || fail "MW_RECORD is '$record', must be ON or OFF"
  # Who does not ask for Python leaves it as it was configured last.
  [[ -n $python ]] || python=$(configured_python)
  [[ $python == ON || $python == OFF ]] || fail "MW_PYTHON is '$python', must be ON or OFF"
  if [[ $python == ON ]]; then packages+=("${python_packages[@]}"); fi
  install_packages "${packages[@]}"
  mkdir -p "$root/build"
  exec 9>"$root/build/release.lock"
  flock 9
  [[ $mjcf == OFF ]] || fetch_mujoco
  [[ $python == OFF ]] || make_python_environment
  configure "$mjcf" "$record" "$python"
  cmake --build "$build_dir" --target "$target" --parallel "$(nproc)" >&2 9>&- ||
    fail "the build failed"
  exec 9>&-
}
