#!/bin/sh
# Builds the HDF5 that Python wheels contain: DIR/include, DIR/lib/libhdf5.a and DIR/LICENSE. Debian's
# library would add OpenSSL, curl, Kerberos and others to a wheel; this one needs zlib only. The sources
# come with a crate. Needs a C compiler, Ninja, zlib's headers, and python3 with venv. CMake 3.26 or later
# comes from PyPI where the installed one is older. Quick when DIR already has this version. Prints on
# standard error only; exit 0 done, 1 failed, 2 bad usage.
set -eu

crate=hdf5-metno-src
crate_version=0.10.4  # HDF5 2.2.0
sha256=69c883c565498492954e344c482f8622525e58c7a71100dd9498c4940da82885
build=3  # increase it when the options below change

say() { echo "build_hdf5: $*" >&2; }
fail() { say "$*"; exit 1; }

if [ $# -ne 1 ] || [ -z "$1" ]; then
  echo "usage: tools/scripts/build_hdf5.sh DIR" >&2
  exit 2
fi
dir=${1%/}
version="$crate $crate_version, build $build"
[ "$(cat "$dir/version" 2>/dev/null)" = "$version" ] && [ -e "$dir/lib/libhdf5.a" ] && exit 0
if [ -e "$dir" ] && [ ! -e "$dir/version" ] && [ -n "$(ls -A "$dir" 2>/dev/null)" ]; then
  fail "$dir exists and was not made by this script; remove it or name another folder"
fi
scripts=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$(dirname "$dir")" || fail "cannot make $(dirname "$dir")"
parent=$(cd "$(dirname "$dir")" && pwd)
crate_dir=$parent/crates/$crate
"$scripts/fetch_crate.sh" "$crate" "$crate_version" "$sha256" "$crate_dir" || exit 1

# Two of these at a time would build in the same folder, whose name is fixed for the sake of ccache.
work=$dir.build
exec 8>"$dir.lock"
flock 8
[ "$(cat "$dir/version" 2>/dev/null)" = "$version" ] && exit 0
rm -rf "$work"
mkdir -p "$work"
trap 'rm -rf "$work"' EXIT
trap 'exit 1' INT TERM HUP

cmake=cmake
if ! cmake --version 2>/dev/null | awk '/^cmake version/ { split($3, v, "."); found = v[1] > 3 || (v[1] == 3 && v[2] >= 26) }
     END { exit !found }'; then
  say "fetching CMake from PyPI"
  python3 -m venv "$work/python" >&2 || fail "python3 cannot make an environment; apt-get install python3-venv"
  "$work/python/bin/python" -m pip install --quiet --disable-pip-version-check --no-input 'cmake>=3.26,<5' >&2 ||
    fail "pip could not install CMake"
  cmake=$work/python/bin/cmake
fi
launcher=
if command -v ccache >/dev/null; then
  # Objects of any clone: paths are stored relative to its folder.
  export CCACHE_BASEDIR="${CCACHE_BASEDIR:-$parent}" CCACHE_NOHASHDIR=1
  launcher=ccache
fi

say "compiling HDF5, which takes a minute or two"
off=
for option in BUILD_SHARED_LIBS BUILD_TESTING HDF5_BUILD_CPP_LIB HDF5_BUILD_EXAMPLES HDF5_BUILD_FORTRAN \
    HDF5_BUILD_HL_LIB HDF5_BUILD_JAVA HDF5_BUILD_TOOLS HDF5_BUILD_UTILS HDF5_ENABLE_DEPRECATED_SYMBOLS \
    HDF5_ENABLE_DIRECT_VFD HDF5_ENABLE_HDFS HDF5_ENABLE_NONSTANDARD_FEATURES HDF5_ENABLE_PARALLEL \
    HDF5_ENABLE_ROS3_VFD HDF5_ENABLE_SZIP_SUPPORT HDF5_ENABLE_THREADSAFE; do
  off="$off -D $option=OFF"
done
# Sections, so that a linker leaves out what nobody calls. src/record calls HDF5 from one thread at a time.
# shellcheck disable=SC2086
{
  "$cmake" -S "$crate_dir/ext/hdf5" -B "$work/build" -G Ninja $off \
    -D HDF5_ENABLE_ZLIB_SUPPORT=ON -D HDF5_NO_PACKAGES=ON \
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_C_FLAGS_RELEASE="-Os -DNDEBUG" \
    -D CMAKE_C_FLAGS="-ffunction-sections -fdata-sections -fvisibility=hidden -fno-asynchronous-unwind-tables" \
    -D CMAKE_POSITION_INDEPENDENT_CODE=ON -D CMAKE_C_COMPILER_LAUNCHER=$launcher \
    -D CMAKE_INSTALL_LIBDIR=lib -D CMAKE_INSTALL_PREFIX="$work/installed" &&
  "$cmake" --build "$work/build" --parallel "${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" &&
  "$cmake" --install "$work/build"
} >"$work/log" 2>&1 || { tail -n 20 "$work/log" >&2; fail "HDF5 could not be built"; }

mkdir -p "$work/new/lib"
mv "$work/installed/include" "$work/new/include"
mv "$work/installed/lib/libhdf5.a" "$work/new/lib"
cp "$crate_dir/ext/hdf5/LICENSE" "$work/new/LICENSE"
sed -n 's/^#define H5_VERS_INFO.*//; s/^#define H5_VERS_\(MAJOR\|MINOR\|RELEASE\) *\([0-9]*\)$/\2/p' \
  "$work/new/include/H5public.h" | paste -sd. >"$work/new/hdf5_version"
[ -s "$work/new/hdf5_version" ] || fail "cannot determine the version of HDF5"
echo "$version" >"$work/new/version"
[ ! -e "$dir" ] || mv -T "$dir" "$work/old" || fail "cannot replace $dir"
mv -T "$work/new" "$dir" || fail "cannot rename into $dir"
say "HDF5 $(cat "$dir/hdf5_version") is in $dir"
