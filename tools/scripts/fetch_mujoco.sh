#!/bin/sh
# Puts MuJoCo's headers, shared library and licences into DIR/include, DIR/lib and DIR, from the PyPI
# wheel `mujoco-core`. Needs python3 with pip. Quick when DIR already has this version. Prints on standard
# error only; exit 0 done, 1 failed, 2 bad usage.
set -eu

# From 4.0.0 on `mujoco-core` carries the library, and `mujoco` only names it and others; 4.0.0 itself
# had a wrong Hessian factor. One wheel serves every python3, because only its C part is used.
version=4.0.1
sha256=be28c0c7587347ef996b4de0487264e9da296282082b092bae211a9163e9aed6

say() { echo "fetch_mujoco: $*" >&2; }
fail() { say "$*"; exit 1; }

if [ $# -ne 1 ] || [ -z "$1" ]; then
  echo "usage: tools/scripts/fetch_mujoco.sh DIR" >&2
  exit 2
fi
dir=${1%/}

if [ "$(cat "$dir/version" 2>/dev/null)" = "$version" ] &&
   [ -e "$dir/lib/libmujoco.so" ] && [ -e "$dir/include/mujoco/mujoco.h" ] &&
   [ -e "$dir/LICENSE" ]; then
  exit 0
fi
# Only a folder of ours may be replaced.
if [ -e "$dir" ] && [ ! -e "$dir/version" ] && [ -n "$(ls -A "$dir" 2>/dev/null)" ]; then
  fail "$dir exists and was not made by this script; remove it or name another folder"
fi
[ "$(uname -s)-$(uname -m)" = Linux-x86_64 ] ||
  fail "only Linux on x86-64 is supported, this is $(uname -s) on $(uname -m)"
command -v python3 >/dev/null || fail "python3 is missing; apt-get install python3-pip"
python3 -m pip --version >/dev/null 2>&1 || fail "pip is missing; apt-get install python3-pip"

mkdir -p "$(dirname "$dir")" || fail "cannot make $(dirname "$dir")"
# Everything is made beside DIR and renamed, so that DIR is never half there.
work=$(mktemp -d "$dir.XXXXXX") || fail "cannot write next to $dir"
trap 'rm -rf "$work"' EXIT
trap 'exit 1' INT TERM HUP

say "downloading the mujoco-core $version wheel (10 MB)"
echo "mujoco-core==$version --hash=sha256:$sha256" > "$work/requirements.txt"
if ! python3 -m pip download --quiet --disable-pip-version-check --no-input --no-deps \
    --only-binary=:all: --implementation cp --python-version 3.11 --abi cp311 \
    --platform manylinux_2_28_x86_64 --require-hashes --dest "$work/wheel" \
    -r "$work/requirements.txt" > "$work/log" 2>&1; then
  reason=$(grep -m 1 ERROR "$work/log" || tail -n 1 "$work/log")
  fail "pip could not download mujoco-core $version: ${reason:-no reason given}"
fi

say "unpacking into $dir"
python3 - "$work" > "$work/log" 2>&1 <<'PYTHON' ||
import pathlib, sys, zipfile
work = pathlib.Path(sys.argv[1])
(wheel,) = (work / "wheel").glob("mujoco_core-*.whl")
with zipfile.ZipFile(wheel) as archive:
    for name in archive.namelist():
        path = pathlib.PurePosixPath(name)
        if name.startswith("mujoco/include/mujoco/") and path.suffix == ".h":
            target = work / "new" / path.relative_to("mujoco")
        elif path.parent.name == "mujoco" and path.name.startswith("libmujoco.so."):
            target = work / "new" / "lib" / path.name
        elif path.parent.name == "licenses" and path.name.startswith("LICENSE"):
            target = work / "new" / path.name
        else:
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(archive.read(name))
PYTHON
  fail "cannot unpack the wheel: $(tail -n 1 "$work/log")"

[ -e "$work/new/lib/libmujoco.so.$version" ] || fail "the wheel has no libmujoco.so.$version"
[ -e "$work/new/LICENSE" ] || fail "the wheel has no licence"
[ -e "$work/new/include/mujoco/mujoco.h" ] || fail "the wheel has no mujoco/mujoco.h"
ln -s "libmujoco.so.$version" "$work/new/lib/libmujoco.so"
echo "$version" > "$work/new/version"

if [ -e "$dir" ]; then
  mv -T "$dir" "$work/old" || fail "cannot replace $dir"
fi
mv -T "$work/new" "$dir" || fail "cannot rename into $dir"
say "mujoco $version is in $dir"
