#!/usr/bin/env python3
"""How .ci/run runs its stages, sums them up and notes the tree they passed on, with stages made up here."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/scripts"))
import ci_table  # noqa: E402

RUN = """#!/bin/bash
set -uo pipefail
cd "$(dirname "$0")"
source tools/scripts/ci_stages.sh
stage_good() {{ timed build true; timed run true; }}
stage_other() {{ {other}; echo "the end of other"; }}
stage_tests() {{ cp tests.xml "$report/tests.xml"; }}
run_stages "${{@:-other good tests}}"
"""
JUNIT = """<testsuite><testcase name="slow" classname="slow" time="7.5" status="run"/>
<testcase name="python" classname="python" time="99" status="run"/>
<testcase name="broken" classname="broken" time="0.5" status="fail"><failure message=""/><system-out>first
expected 1, was 2
</system-out></testcase>
<testcase name="test_a" classname="python.tests.test_x" time="1.25"/></testsuite>"""


class Stages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.checkout = self.root / "checkout"
        scripts = self.checkout / "tools/scripts"
        scripts.mkdir(parents=True)
        for name in ("ci_stages.sh", "ci_table.py"):
            (scripts / name).write_text((ROOT / "tools/scripts" / name).read_text())
        (self.checkout / ".gitignore").write_text("build\n__pycache__\n")
        (self.checkout / "tests.xml").write_text(JUNIT)
        self.write("true")

    def write(self, other):
        (self.checkout / "run").write_text(RUN.format(other=other))
        git = ["git", "-c", "user.name=a", "-c", "user.email=a@b"]
        for command in (["git", "init", "-q"], ["git", "add", "-A"], [*git, "commit", "-qm", "all"]):
            subprocess.run(command, cwd=self.checkout, check=True)

    def run_stages(self, *names):
        environment = os.environ | {"XDG_CACHE_HOME": str(self.root / "cache")}
        return subprocess.run(["bash", str(self.checkout / "run"), *names], env=environment, text=True,
                              capture_output=True, timeout=60, check=False)

    def passed(self):
        file = self.root / "cache/manyworlds/ci_passed"
        return file.read_text().split() if file.exists() else []

    def tree(self):
        return subprocess.run(["git", "rev-parse", "HEAD^{tree}"], cwd=self.checkout, text=True,
                              capture_output=True, check=True).stdout.split()

    def test_all_pass_and_the_tree_is_noted(self):
        outcome = self.run_stages()
        self.assertEqual(outcome.returncode, 0, outcome.stdout + outcome.stderr)
        self.assertEqual(outcome.stdout.splitlines()[-1], "stages: 3 passed, 0 failed")
        self.assertEqual(self.passed(), self.tree())

    def test_a_failed_stage_lets_the_others_run(self):
        self.write("false")
        outcome = self.run_stages()
        self.assertEqual(outcome.returncode, 1)
        self.assertNotIn("the end of other", outcome.stdout)
        self.assertRegex(outcome.stdout, r"\nother .* failed, exit status 1\n")
        self.assertRegex(outcome.stdout, r"\ngood .* passed\n")
        self.assertEqual(outcome.stdout.splitlines()[-1], "stages: 2 passed, 1 failed")
        self.assertEqual(self.passed(), [])

    def test_some_stages_or_a_changed_checkout_note_nothing(self):
        self.assertEqual(self.run_stages("good").returncode, 0)
        (self.checkout / "new").write_text("")
        outcome = self.run_stages()
        self.assertEqual(outcome.returncode, 0)
        self.assertIn("not committed", outcome.stdout)
        self.assertEqual(self.passed(), [])

    def test_an_unknown_stage_is_named(self):
        outcome = self.run_stages("goodd")
        self.assertEqual(outcome.returncode, 2)
        self.assertIn("there is no stage 'goodd'; stages: good other tests", outcome.stderr)

    def test_slowest_tests_are_listed(self):
        lines = self.run_stages().stdout.splitlines()
        first = next(i for i, line in enumerate(lines) if line.startswith("slowest of"))
        self.assertEqual(lines[first], "slowest of 3 tests, s, and the sum up to each of 9 s in all")
        self.assertEqual(lines[first + 1].split(), ["7.5", "8", "tests", "slow"])
        self.assertEqual(lines[first + 2].split(), ["1.2", "9", "tests", "python.tests.test_x::test_a"])

    def test_failed_tests_of_a_failed_stage_are_named_with_what_they_printed(self):
        self.write('cp tests.xml "$report/other.xml"; false')
        told = "failed in other: broken\n    first\n    expected 1, was 2\n"
        self.assertIn(told, self.run_stages().stdout)

    def test_times_go_to_phases(self):
        folder = self.root / "times"
        folder.mkdir()
        (folder / "a.times").write_text("compile\t10\t14\nconfigure\t8\t10\nrun\t14\t15\n")
        stage = ci_table.Stage(folder, "a", "0", "7", "20")
        self.assertEqual(stage.phases, {"setup": 2.0, "build": 4.0, "run": 7.0})


if __name__ == "__main__":
    unittest.main()
