#!/bin/sh
# Puts the sources that a crate of crates.io carries into DIR. Crates of C and C++ libraries hold the
# library's own sources and licence, which need no Rust to compile. Needs python3. Quick when DIR
# already has this version. Prints on standard error only; exit 0 done, 1 failed, 2 bad usage.
set -eu

say() { echo "fetch_crate: $*" >&2; }
fail() { say "$*"; exit 1; }

if [ $# -ne 4 ] || [ -z "$4" ]; then
  echo "usage: tools/scripts/fetch_crate.sh NAME VERSION SHA256 DIR" >&2
  exit 2
fi
name=$1 version=$2 sha256=$3 dir=${4%/}

[ "$(cat "$dir/version" 2>/dev/null)" = "$version" ] && exit 0
# Only a folder of ours may be replaced.
if [ -e "$dir" ] && [ ! -e "$dir/version" ] && [ -n "$(ls -A "$dir" 2>/dev/null)" ]; then
  fail "$dir exists and was not made by this script; remove it or name another folder"
fi
command -v python3 >/dev/null || fail "python3 is missing; apt-get install python3"

mkdir -p "$(dirname "$dir")" || fail "cannot make $(dirname "$dir")"
# Everything is made beside DIR and renamed, so that DIR is never half there.
work=$(mktemp -d "$dir.XXXXXX") || fail "cannot write next to $dir"
trap 'rm -rf "$work"' EXIT
trap 'exit 1' INT TERM HUP

say "downloading $name $version"
python3 - "$name" "$version" "$sha256" "$work/new" > "$work/log" 2>&1 <<'PYTHON' ||
import hashlib, io, pathlib, sys, tarfile, urllib.parse, urllib.request
name, version, wanted, target = sys.argv[1:]
file = urllib.parse.quote(f"{name}-{version}.crate")
url = f"https://static.crates.io/crates/{name}/{file}"
with urllib.request.urlopen(url, timeout=120) as answer:
    data = answer.read()
found = hashlib.sha256(data).hexdigest()
if found != wanted:
    sys.exit(f"its SHA-256 is {found}, expected {wanted}")
root = pathlib.Path(target)
with tarfile.open(fileobj=io.BytesIO(data), mode="r:gz") as archive:
    for member in archive:
        path = pathlib.PurePosixPath(member.name)
        if not member.isfile() or ".." in path.parts or path.is_absolute():
            continue
        out = root.joinpath(*path.parts[1:])
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_bytes(archive.extractfile(member).read())
PYTHON
  fail "cannot fetch $name $version: $(tail -n 1 "$work/log")"
echo "$version" > "$work/new/version"

if [ -e "$dir" ]; then
  mv -T "$dir" "$work/old" || fail "cannot replace $dir"
fi
mv -T "$work/new" "$dir" || fail "cannot rename into $dir"
say "$name $version is in $dir"
