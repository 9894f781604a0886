#!/usr/bin/env python3
"""Prints where the time of .ci/run went: its stages, its slowest tests, and what failed.

    tools/scripts/ci_table.py FOLDER [--count 40]

FOLDER is what .ci/run leaves in build/ci: `stages` (name, exit status, start, end), `NAME.times`
(phase, start, end) and JUnit files `NAME.xml` of ctest and `NAME-python.xml` of pytest. Times are in
seconds. Exit status 1 when a stage failed or none ran.
"""

import argparse
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

PHASES = ("setup", "build", "run")
# tools/test and its like name finer phases (`took` in tools/scripts/setup.sh).
PHASE_OF = {"packages": "setup", "configure": "setup", "compile": "build"}


def rows(path):
    """The tab-separated lines of a file, none where it is missing."""
    return [line.split("\t") for line in path.read_text().splitlines()] if path.is_file() else []


class Stage:
    """A stage of .ci/run: its times by phase in s, and its tests as (seconds, name, failed, output)."""

    def __init__(self, folder, name, status, start, end):
        self.name, self.status = name, int(status)
        self.seconds = float(end) - float(start)
        self.phases = dict.fromkeys(PHASES, 0.0)
        for phase, since, until in rows(folder / f"{name}.times"):
            self.phases[PHASE_OF.get(phase, phase)] += float(until) - float(since)
        self.tests = []
        for file in (folder / f"{name}.xml", folder / f"{name}-python.xml"):
            if file.is_file():
                self.tests += cases(file)
        measured = sum(self.phases.values())
        self.phases["run"] += max(0.0, self.seconds - measured)


def cases(file):
    """The tests of a JUnit file; ctest's entry for pytest is left out, since pytest lists its own."""
    try:
        root = ElementTree.parse(file).getroot()
    except ElementTree.ParseError:
        return []  # the runner was stopped while it wrote
    found = []
    for case in root.iter("testcase"):
        name = case.get("name", "")
        failed = case.find("failure") is not None or case.find("error") is not None
        if name == "python" and not failed:
            continue
        if case.get("classname", name) != name:
            name = f"{case.get('classname')}::{name}"
        found.append((float(case.get("time") or 0), name, failed, output_of(case) if failed else ""))
    return found


def output_of(case):
    """What a test printed, and why it failed: ctest and pytest have both in different places."""
    parts = [case.find(tag) for tag in ("system-out", "system-err", "failure", "error")]
    return "\n".join(part.text.strip("\n") for part in parts if part is not None and part.text)


def print_stages(stages):
    print(f"\n{'stage':10}{'setup':>8}{'build':>8}{'run':>8}{'total':>8}{'so far':>8}  tests  result")
    so_far = 0.0
    for stage in stages:
        so_far += stage.seconds
        times = "".join(f"{stage.phases[phase]:8.0f}" for phase in PHASES)
        result = "passed" if stage.status == 0 else f"failed, exit status {stage.status}"
        print(f"{stage.name:10}{times}{stage.seconds:8.0f}{so_far:8.0f}{len(stage.tests):7}  {result}")


def print_slowest(stages, count):
    tests = [(seconds, stage.name, name) for stage in stages for seconds, name, *_ in stage.tests]
    tests.sort(reverse=True)
    total = sum(seconds for seconds, *_ in tests)
    if not tests:
        return
    print(f"\nslowest of {len(tests)} tests, s, and the sum up to each of {total:.0f} s in all")
    so_far = 0.0
    for seconds, stage, name in tests[:count]:
        so_far += seconds
        print(f"{seconds:8.1f}{so_far:8.0f}  {stage:8} {name[:120]}")


def main():
    parser = argparse.ArgumentParser(description="where the time of .ci/run went")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--count", type=int, default=40, help="how many tests to list")
    parser.add_argument("--lines", type=int, default=40, help="how much of what a failed test printed")
    options = parser.parse_args()
    stages = [Stage(options.folder, *row) for row in rows(options.folder / "stages")]
    print_slowest(stages, options.count)
    print_stages(stages)
    failed = [stage for stage in stages if stage.status != 0]
    for stage in failed:
        for _, name, bad, output in stage.tests:
            if bad:
                print(f"failed in {stage.name}: {name}")
                for line in output.splitlines()[-options.lines :]:
                    print(f"    {line}")
    print(f"stages: {len(stages) - len(failed)} passed, {len(failed)} failed")
    return 1 if failed or not stages else 0


if __name__ == "__main__":
    sys.exit(main())
