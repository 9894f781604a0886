#!/usr/bin/env python3
"""What the program does with --help next to a mistake, and with terminals.

    tests/tools/cli_terminal_test.py PROGRAM
"""

import os
import pathlib
import pty
import signal
import subprocess
import sys
import time
import unittest

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else None


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False)


class Help(unittest.TestCase):
    def test_a_mistake_is_told_in_spite_of_help(self):
        for arguments, message in (
            (["nosuch", "--help"], "unknown command 'nosuch'"),
            (["--help", "nosuch"], "unknown command 'nosuch'"),
            (["runn", "--help"], "unknown command 'runn'; did you mean 'run'?"),
            (["nosuch", "--version"], "unknown command 'nosuch'"),
            (["report", "nosuch", "--help"], "unknown report 'nosuch'"),
            (["run", "--nosuch", "--help"], "unknown option '--nosuch'"),
            (["run", "ball3d", "stack10", "--help"], "stack10"),
        ):
            with self.subTest(arguments):
                outcome = run(*arguments)
                self.assertEqual((outcome.returncode, outcome.stdout), (2, ""))
                self.assertTrue(outcome.stderr.startswith("manyworlds: "))
                self.assertIn(message, outcome.stderr)
                self.assertEqual(outcome.stderr.count("\n"), 1)

    def test_help_alone_is_no_mistake(self):
        for arguments in (["--help"], ["--version"], ["run", "--help"], ["run", "ball3d", "--help"],
                          ["report", "--help"], ["report", "plan", "--help"], ["completion", "--help"]):
            outcome = run(*arguments)
            self.assertEqual((outcome.returncode, outcome.stderr), (0, ""), arguments)


class Terminal(unittest.TestCase):
    def seen(self, term):
        """What a terminal gets of a run of 3 s, interrupted."""
        environment = {k: v for k, v in os.environ.items() if k != "TERM"}
        environment.update({"TERM": term} if term else {})
        terminal, end = pty.openpty()
        with subprocess.Popen([PROGRAM, "run", "ball3d", "--worlds", "8", "--steps", "2000000000"],
                              stdout=subprocess.DEVNULL, stderr=end, env=environment) as process:
            os.close(end)
            time.sleep(3)
            process.send_signal(signal.SIGINT)
            text = b""
            while True:
                try:
                    part = os.read(terminal, 4096)
                except OSError:  # the other end is closed
                    break
                if not part:
                    break
                text += part
        os.close(terminal)
        self.assertEqual(process.returncode, 130)
        self.assertIn(b"interrupted", text)
        return text

    def test_a_dumb_terminal_gets_no_escapes(self):
        self.assertIn(b"\x1b[K", self.seen("xterm"))
        for term in ("dumb", None):
            text = self.seen(term)
            self.assertNotIn(b"\x1b", text)
            self.assertEqual(text.count(b"\n"), 1, text)


if __name__ == "__main__":
    unittest.main()
