#!/usr/bin/env python3
"""README.md is short. docs/cli.md has every command, and no option that the program lacks."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
CLI = (ROOT / "docs/cli.md").read_text(encoding="utf-8")
PROGRAM = "".join(p.read_text(encoding="utf-8") for p in sorted((ROOT / "tools/cli").glob("*.?pp")))
SCRIPTS = "".join((ROOT / "tools" / name).read_text(encoding="utf-8") for name in ("run", "fuzz", "wheel"))


class Readme(unittest.TestCase):
    def test_has_at_most_150_lines(self):
        self.assertLessEqual(README.count("\n"), 150)

    def test_shows_python_early_and_in_ten_lines(self):
        first = re.search(r"```python\n(.*?)```", README, re.S)
        self.assertLess(README[: first.start()].count("\n"), 30)
        self.assertEqual(len([line for line in first[1].splitlines() if line.strip()]), 10)

    def test_says_which_package_it_is(self):
        self.assertRegex(README, r"PyPI's `manyworlds` is another project")


class CommandLine(unittest.TestCase):
    def test_has_every_command(self):
        commands = set(re.findall(r'add_subcommand\(\s*"([a-z]+)"', PROGRAM))
        self.assertGreaterEqual(len(commands), 12)
        reports = {"accuracy", "stability", "invariants", "plan", "throughput", "page"}
        for command in commands - reports | {"plan"}:
            self.assertRegex(CLI, rf"(?m)^## {command}$")
            self.assertIn(f"[`{command}`](#{command})", CLI)
        for report in reports:
            self.assertIn(f"manyworlds report {report}", CLI)

    def test_names_no_option_that_the_program_lacks(self):
        for option in sorted(set(re.findall(r"--[a-z][a-z0-9-]*", CLI)) - {"--help"}):
            self.assertTrue(f'"{option}"' in PROGRAM or option in SCRIPTS, option)

    def test_names_every_environment_variable(self):
        variables = set(re.findall(r'"(MANYWORLDS_[A-Z]+)"', PROGRAM)) | {"MANYWORLDS_ISA"}
        self.assertGreaterEqual(len(variables), 3)
        for variable in variables:
            self.assertIn(variable, CLI)


if __name__ == "__main__":
    unittest.main()
