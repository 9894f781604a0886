#!/usr/bin/env python3
"""Completion in bash and zsh, by the scripts that the program prints.

    tests/tools/completion_test.py PROGRAM

What zsh completes is tested where zsh is found.
"""

import os
import pathlib
import pty
import re
import select
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else None
ZSH = shutil.which("zsh")


def program(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=True).stdout


def scenes():
    return [line.split()[0] for line in program("scenes").splitlines()]


class Bash(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        path = pathlib.Path(cls.folder.name)
        (path / "completion").write_text(program("completion", "bash"))
        for name in ("pile.xml", "run.h5", "page.html", "two words.xml"):
            (path / name).touch()
        (path / "models").mkdir()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def complete(self, *words):
        """What Tab behind the last word offers; the words are split as Readline splits them."""
        split = [part for word in words for part in (re.split(r"([=:])", word) if word else [""])]
        split = [part for i, part in enumerate(split) if part or i == len(split) - 1]
        run = subprocess.run(
            ["bash", "--norc", "-c", 'source completion; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); '
             '_manyworlds; printf "%s\\n" "${COMPREPLY[@]}"', "bash", "manyworlds", *split],
            cwd=self.folder.name, capture_output=True, text=True, check=True)
        self.assertEqual(run.stderr, "")
        return [line for line in run.stdout.splitlines() if line]

    def test_commands(self):
        listed = self.complete("")
        help_text = program("--help")
        for name in listed:
            self.assertIn(f"\n  {name} ", help_text)
        for name in ("run", "bench", "verify", "view", "report", "completion"):
            self.assertIn(name, listed)
        self.assertEqual(self.complete("ver"), ["verify"])
        self.assertEqual(self.complete("report", "t"), ["throughput"])
        self.assertEqual(self.complete("completion", ""), ["bash", "zsh"])

    def test_options_are_those_of_help(self):
        for path in ([], ["run"], ["plan"], ["view"], ["verify"], ["report", "plan"]):
            expected = set(re.findall(r"(?m)^  (?:-\w,)?(--[\w-]+)", program(*path, "--help")))
            self.assertEqual({o for o in self.complete(*path, "-") if o.startswith("--")}, expected)
        self.assertEqual(self.complete("run", "bin-boxes", "--prec"), ["--precision"])

    def test_values_of_choices(self):
        self.assertEqual(self.complete("run", "--isa", ""), ["scalar", "avx2", "avx512"])
        self.assertEqual(self.complete("run", "--isa=av"), ["avx2", "avx512"])
        self.assertEqual(self.complete("run", "--isa="), ["scalar", "avx2", "avx512"])
        self.assertEqual(self.complete("plan", "ball3d", "--solver", "tg"), ["tgs-soft"])
        self.assertEqual(self.complete("bench", "--sleep", ""), ["off", "on", "both"])
        self.assertEqual(self.complete("run", "--sleep", ""), ["off", "on"])
        self.assertEqual(self.complete("run", "--steps", ""), [])

    def test_scenes_and_files(self):
        offered = self.complete("run", "")
        self.assertEqual([name for name in offered if name in scenes()], scenes())
        self.assertEqual(set(offered) - set(scenes()), {"pile.xml", "two words.xml", "models"})
        self.assertEqual(self.complete("run", "stack"), [s for s in scenes() if s.startswith("stack")])
        self.assertEqual(self.complete("replay", ""), ["run.h5", "models"])
        self.assertEqual(self.complete("bench", "--scenes", "ball3d,stack1"), ["ball3d,stack10"])
        self.assertEqual(self.complete("run", "--dump-lost", ""), ["models"])
        self.assertIn("run.h5", self.complete("view", "run.h5", ""))

    def test_paths_of_options(self):
        self.assertEqual(self.complete("run", "x", "--set", "contact.sl"), ["contact.slop="])


@unittest.skipUnless(ZSH, "zsh is not installed")
class Zsh(unittest.TestCase):
    def test_the_script_is_valid(self):
        subprocess.run([ZSH, "-n"], input=program("completion", "zsh"), text=True, check=True)

    def test_what_tab_inserts(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder)
            (path / "_manyworlds").write_text(program("completion", "zsh"))
            (path / "pile.xml").touch()
            for typed, completed in (
                ("manyworlds verif\t", "manyworlds verify "),
                ("manyworlds run stack1\t", "manyworlds run stack10 "),
                ("manyworlds run pil\t", "manyworlds run pile.xml "),
                ("manyworlds run ball3d --prec\t", "manyworlds run ball3d --precision"),
                ("manyworlds run ball3d --isa sc\t", "manyworlds run ball3d --isa scalar "),
                ("manyworlds bench --scenes ball3d,stack1\t", "manyworlds bench --scenes ball3d,stack10"),
                ("manyworlds report throughp\t", "manyworlds report throughput "),
                ("manyworlds plan ball3d --set contact.sl\t", "manyworlds plan ball3d --set contact.slop="),
                ("manyworlds completion z\t", "manyworlds completion zsh "),
            ):
                with self.subTest(typed):
                    self.assertIn(completed, self.shown(path, typed))

    def shown(self, folder, typed):
        """The line of an interactive zsh after what was typed."""
        (folder / ".zshrc").write_text(
            f"fpath=({folder} $fpath)\nautoload -Uz compinit\ncompinit -u -D\nPS1='> '\n"
            "bindkey '^I' complete-word\nbindkey '^X' show\n"
            "show() { print -r -- \"$BUFFER\" >part; mv part shown; exit }\nzle -N show\n")
        environment = {**os.environ, "ZDOTDIR": str(folder), "TERM": "dumb", "HOME": str(folder)}
        child, terminal = pty.fork()
        if child == 0:
            os.chdir(folder)
            os.execve(ZSH, [ZSH, "-i"], environment)
        (folder / "shown").unlink(missing_ok=True)
        sent = False
        end = time.monotonic() + 20
        try:
            while time.monotonic() < end and not (folder / "shown").exists():
                if select.select([terminal], [], [], 0.1)[0]:
                    try:
                        text = os.read(terminal, 4096)
                    except OSError:
                        break
                    if not sent and b"> " in text:
                        os.write(terminal, typed.encode() + b"\x18")
                        sent = True
        finally:
            os.close(terminal)
            os.waitpid(child, 0)
        return (folder / "shown").read_text() if (folder / "shown").exists() else ""


if __name__ == "__main__":
    unittest.main()
