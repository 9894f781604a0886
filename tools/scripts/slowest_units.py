#!/usr/bin/env python3
"""The translation units that took longest to compile, from a build folder's ninja log.

    tools/scripts/slowest_units.py [BUILD_DIR] [--count 15] [--limit 20]

BUILD_DIR defaults to build/release. Times are of each unit's last build, on a machine that was busy
with the others; units that ccache answered look fast (CCACHE_DISABLE=1 gives true times). With
--limit, exits 1 when a unit took more seconds than that.
"""

import argparse
import sys
from pathlib import Path


def units(log):
    """{object: seconds} from a ninja log: tab-separated start ms, end ms, mtime, output, hash."""
    found = {}
    for line in log.read_text(encoding="utf-8").splitlines():
        fields = line.split("\t")
        if len(fields) >= 4 and fields[3].endswith(".o"):
            found[fields[3]] = (int(fields[1]) - int(fields[0])) / 1000
    return found


def main():
    parser = argparse.ArgumentParser(description="the slowest translation units of a build")
    parser.add_argument("build_dir", nargs="?", type=Path, default=Path("build/release"))
    parser.add_argument("--count", type=int, default=15)
    parser.add_argument("--limit", type=float, help="s; exit 1 when a unit takes longer")
    options = parser.parse_args()

    log = options.build_dir / ".ninja_log"
    if not log.is_file():
        print(f"{log}: not there; build first", file=sys.stderr)
        return 2
    seconds = units(log)
    order = sorted(seconds, key=seconds.get, reverse=True)
    for name in order[:options.count]:
        print(f"{seconds[name]:7.1f} s  {name.replace('CMakeFiles/', '')}")
    print(f"{sum(seconds.values()):7.1f} s  all {len(seconds)} units")
    over = [n for n in order if options.limit is not None and seconds[n] > options.limit]
    if over:
        print(f"{len(over)} units took more than {options.limit:g} s", file=sys.stderr)
    return 1 if over else 0


if __name__ == "__main__":
    sys.exit(main())
