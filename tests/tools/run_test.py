#!/usr/bin/env python3
"""What tools/run and tools/test configure and build: a build of what the arguments need, that grows.

Runs the scripts themselves in a folder of their own, with a cmake, a ninja and a dpkg-query that only
write down what they were asked for, and a program that says how it was called.
"""

import os
import pathlib
import pty
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/scripts"))
import progress  # noqa: E402

AVX2 = "avx2 fma bmi2"
AVX512 = AVX2 + " avx512f avx512vl avx512dq avx512bw"

CMAKE = """#!/bin/bash
if [[ $1 == --build ]]; then
  echo "build ${*: -3:1}" >>"$LOG"
  echo "[1/2] Building CXX object a.o"
  echo "[2/2] Linking CXX executable b"
  exit "${BUILD_STATUS:-0}"
fi
printf 'configure' >>"$LOG"
for a in "$@"; do [[ $a != MW_*=* ]] || printf '|%s' "$a" >>"$LOG"; done
echo >>"$LOG"
mkdir -p "$ROOT/build/release/bin"
touch "$ROOT/build/release/build.ninja"
echo "CMAKE_COMMAND:INTERNAL=$0" >"$ROOT/build/release/CMakeCache.txt"
printf '#!/bin/bash\\necho "program: $*"\\nexit "${PROGRAM_STATUS:-0}"\\n' >"$ROOT/build/release/bin/manyworlds"
chmod +x "$ROOT/build/release/bin/manyworlds"
"""
NINJA = """#!/bin/bash
if [[ " $* " == *" -f "* && " $* " == *" -n "* ]]; then
  for i in {1..9}; do echo "[$i/9] Building CXX object x$i.o"; done
fi
"""
DPKG_QUERY = """#!/bin/bash
for a in "${@:4}"; do printf 'installed:%s ' "$a"; done
"""


class Checkout:
    """A copy of the scripts, and what they did so far."""

    def __init__(self, folder, flags):
        self.root = pathlib.Path(folder)
        shutil.copytree(ROOT / "tools", self.root / "tools")
        (self.root / "tools/scripts/fetch_mujoco.sh").write_text("#!/bin/sh\n")
        for name in ("CMakePresets.json", "pyproject.toml"):
            (self.root / name).write_text("{}")
        os.utime(self.root / "CMakePresets.json", (0, 0))
        (self.root / "cpu").write_text(f"flags\t\t: fpu {flags} last\n")
        stubs = self.root / "stubs"
        stubs.mkdir()
        programs = {"cmake": CMAKE, "dpkg-query": DPKG_QUERY, "ninja": NINJA,
                    "ctest": "#!/bin/sh\n"}
        for name, text in programs.items():
            (stubs / name).write_text(text)
            (stubs / name).chmod(0o755)

    def run(self, *arguments, script="run", **environment):
        """The outcome, with the options of the last cmake in `configured` (None: not called)."""
        log = self.root / "log"
        log.write_text("")
        left_out = ("MW_", "MANYWORLDS_")
        variables = {k: v for k, v in os.environ.items() if not k.startswith(left_out)}
        variables |= {"PATH": f"{self.root / 'stubs'}:{os.environ['PATH']}", "LOG": str(log),
                      "ROOT": str(self.root), "MW_CPU_INFO": str(self.root / "cpu")} | environment
        outcome = subprocess.run([self.root / "tools" / script, *arguments], env=variables,
                                 capture_output=True, text=True, timeout=60, check=False)
        lines = log.read_text().splitlines()
        configured = [line.split("|")[1:] for line in lines if line.startswith("configure")]
        outcome.configured = dict(o.split("=", 1) for o in configured[-1]) if configured else None
        outcome.built = [line.split()[1] for line in lines if line.startswith("build")]
        return outcome


class Run(unittest.TestCase):
    def checkout(self, flags=AVX2):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        return Checkout(folder.name, flags)

    def test_first_run_builds_one_set_and_no_parts(self):
        for flags, first in (("", "scalar_f32"), (AVX2, "avx2_f32"), (AVX512, "avx512_f32")):
            outcome = self.checkout(flags).run()
            self.assertEqual(outcome.returncode, 0, outcome.stderr)
            self.assertEqual(outcome.configured["MW_KERNELS"], first)
            for part in ("MJCF", "RECORD", "LIVE", "REPORT", "TESTS", "BENCH", "PYTHON"):
                self.assertEqual(outcome.configured["MW_" + part], "OFF", part)
            self.assertEqual(outcome.built, ["manyworlds_cli"])
            self.assertEqual(outcome.stdout, "program: run bin-boxes --worlds 4096 --seconds 5\n")

    def test_arguments_add_what_they_need(self):
        every = ""  # MW_KERNELS: all sets
        cases = [
            (("run", "ball3d", "--record", "/tmp/a.h5"), {"MW_RECORD": "ON", "MW_MJCF": "OFF"}),
            (("run", "ball3d", "--record=a.h5"), {"MW_RECORD": "ON"}),
            (("soak", "ball3d", "--dump-lost", "lost/x"), {"MW_RECORD": "ON", "MW_MJCF": "OFF"}),
            (("replay", "a.h5"), {"MW_RECORD": "ON"}),
            (("view", "runs/a.h5", "--out", "pages/a.html", "--png", "x/a.png"),
             {"MW_RECORD": "ON", "MW_MJCF": "OFF", "MW_VIEWER": "OFF"}),
            (("view", "a.h5", "--mp4", "films/a.mp4"), {"MW_RECORD": "ON", "MW_MJCF": "OFF"}),
            (("view", "robot.xml"), {"MW_RECORD": "ON", "MW_MJCF": "ON", "MW_LIVE": "OFF"}),
            (("view", "ball3d", "--live"), {"MW_LIVE": "ON", "MW_MJCF": "OFF"}),
            (("run", "--json", "scenes/mjcf/box_pile.xml"), {"MW_MJCF": "ON", "MW_RECORD": "OFF"}),
            (("plan", "folder/model"), {"MW_MJCF": "ON"}),
            (("model", "robot.xml"), {"MW_MJCF": "ON"}),
            (("compare", "robot.xml"), {"MW_MJCF": "ON", "MW_KERNELS": "avx2_f32;avx2_f64"}),
            (("report", "plan", "--quick"), {"MW_REPORT": "ON", "MW_KERNELS": every, "MW_VIEWER": "OFF"}),
            (("report", "page", "report/plan.json"), {"MW_REPORT": "OFF", "MW_KERNELS": "avx2_f32"}),
            (("verify",), {"MW_KERNELS": every, "MW_REPORT": "OFF"}),
            (("run", "ball3d", "--precision", "f64"), {"MW_KERNELS": "avx2_f32;avx2_f64"}),
            (("run", "ball3d", "--precision=f64"), {"MW_KERNELS": "avx2_f32;avx2_f64"}),
            (("bench", "--isa", "scalar"), {"MW_KERNELS": "scalar_f32;scalar_f64;avx2_f32"}),
            (("info",), {"MW_KERNELS": "avx2_f32", "MW_MJCF": "OFF"}),
            (("--all", "info"), {"MW_KERNELS": every, "MW_MJCF": "ON", "MW_RECORD": "ON",
                                 "MW_REPORT": "ON", "MW_TESTS": "OFF"}),
        ]
        for arguments, expected in cases:
            with self.subTest(arguments=arguments):
                outcome = self.checkout().run(*arguments)
                self.assertEqual(outcome.returncode, 0, outcome.stderr)
                for name, value in expected.items():
                    self.assertEqual(outcome.configured[name], value, name)

    def test_forced_instruction_set_is_built(self):
        outcome = self.checkout().run("info", MANYWORLDS_ISA="scalar")
        self.assertEqual(outcome.configured["MW_KERNELS"], "scalar_f32;scalar_f64;avx2_f32")

    def test_a_build_keeps_its_parts(self):
        checkout = self.checkout()
        checkout.run("run", "ball3d", "--record", "a.h5")
        again = checkout.run("info")
        self.assertIsNone(again.configured)  # nothing new: not configured again
        (checkout.root / "build/release/CMakeCache.txt").write_text("CMAKE_COMMAND:INTERNAL=/gone/cmake\n")
        self.assertIsNotNone(checkout.run("info").configured)
        self.assertEqual(again.built, ["manyworlds_cli"])
        more = checkout.run("verify")
        self.assertEqual(more.configured["MW_RECORD"], "ON")
        self.assertEqual(more.configured["MW_KERNELS"], "")
        less = checkout.run("info", MW_RECORD="OFF")
        self.assertEqual(less.configured["MW_RECORD"], "OFF")

    def test_tests_after_a_first_run_only_add(self):
        checkout = self.checkout()
        first = checkout.run().configured
        outcome = checkout.run(script="test", MW_PYTHON="OFF")
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        self.assertEqual(outcome.built, ["all"])
        # What makes objects what they are is as it was; what there is to build has grown.
        changed = {name for name in first if outcome.configured[name] != first[name]}
        self.assertEqual(changed, {"MW_KERNELS", "MW_LIVE", "MW_MJCF", "MW_RECORD", "MW_REPORT", "MW_TESTS",
                                   "MW_BENCH", "MW_VIEWER"})

    def test_instruction_sets_of_the_environment(self):
        outcome = self.checkout(AVX512).run(MW_ISAS="scalar;avx2")
        self.assertEqual(outcome.configured["MW_KERNELS"], "avx2_f32")
        self.assertEqual(outcome.configured["MW_ISAS"], "scalar;avx2")
        outcome = self.checkout(AVX2).run(MW_ISAS="avx512")
        self.assertEqual(outcome.returncode, 3)
        self.assertIn("MW_ISAS is 'avx512', none of which this CPU can run", outcome.stderr)
        outcome = self.checkout().run(MW_RECORD="yes")
        self.assertEqual(outcome.returncode, 3)
        self.assertIn("MW_RECORD is 'yes', must be ON or OFF", outcome.stderr)

    def test_outcomes(self):
        checkout = self.checkout()
        self.assertEqual(checkout.run("bench", PROGRAM_STATUS="1").returncode, 1)
        failed = checkout.run(BUILD_STATUS="1")
        self.assertEqual(failed.returncode, 3)
        self.assertEqual(failed.stdout, "")
        self.assertIn("the build failed", failed.stderr)

    def test_the_beginning_says_how_long_it_takes(self):
        error = self.checkout().run().stderr
        self.assertRegex(error, r"tools/run: 9 steps to build, about \d+ s\n")

    def test_the_end_says_where_the_time_went(self):
        checkout = self.checkout()
        slow = (checkout.root / "stubs/cmake").read_text().replace("exit \"${BUILD", "sleep 1.6; exit \"${BUILD")
        (checkout.root / "stubs/cmake").write_text(slow)
        outcome = checkout.run()
        self.assertRegex(outcome.stderr.splitlines()[-1], r"^tools/run: time spent: .*compile [23] s")
        self.assertEqual(outcome.stdout.count("\n"), 1)


class Progress(unittest.TestCase):
    def test_a_dumb_terminal_gets_no_escapes(self):
        code = ("import progress; s = progress.Screen('x'); s.tell('1 of 2'); s.tell('2 of 2'); "
                "s.erase()")
        for term, escapes in (("xterm", True), ("dumb", False), (None, False)):
            environment = {k: v for k, v in os.environ.items() if k != "TERM"}
            environment.update({"TERM": term} if term else {}, PYTHONPATH=str(ROOT / "tools/scripts"))
            terminal, end = pty.openpty()
            subprocess.run([sys.executable, "-c", code], stderr=end, env=environment, check=True)
            os.close(end)
            text = os.read(terminal, 4096)
            os.close(terminal)
            self.assertEqual(b"\x1b" in text, escapes, text)
            self.assertEqual(text.count(b"\n"), 0 if escapes else 2, text)

    def test_times_for_people(self):
        for seconds, text in ((1, "5 s"), (42, "40 s"), (79, "1 min 20 s"), (120, "2 min"),
                              (430, "7 min")):
            self.assertEqual(progress.text_of(seconds), text)

    def test_estimate_follows_costs_and_pace(self):
        kernel = "Building CXX object CMakeFiles/mw_kernels_avx2_f32.dir/kernels/collide/collide_planar.cpp.o"
        small = "Building CXX object CMakeFiles/manyworlds.dir/src/a.cpp.o"
        self.assertGreater(progress.cost_of(kernel), 2 * progress.cost_of(small))
        estimate = progress.Estimate([kernel, small], cores=1)
        before = estimate.seconds_left(0)
        self.assertAlmostEqual(before, estimate.total)
        estimate.finish(kernel)
        on_time = estimate.seconds_left(progress.cost_of(kernel))
        self.assertAlmostEqual(on_time, progress.cost_of(small))
        self.assertGreater(estimate.seconds_left(10 * progress.cost_of(kernel)), 2 * on_time)
        estimate.finish(small)
        self.assertEqual(estimate.seconds_left(20), 0)


if __name__ == "__main__":
    unittest.main()
