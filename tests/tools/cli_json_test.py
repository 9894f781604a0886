#!/usr/bin/env python3
"""The JSON of every command has the keys and types of docs/cli-json.md, and no others.

    tests/tools/cli_json_test.py PROGRAM

Commands that the program was built without are left out.
"""

import json
import os
import pathlib
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else None
DOCUMENT = pathlib.Path(__file__).resolve().parents[2] / "docs/cli-json.md"
ROW = re.compile(r"^\| `([^`]+)` \| ([^|]+) \| ([^|]*) \|$")
MODEL = """<mujoco model="arm">
  <worldbody><geom name="floor" type="plane" size="1 1 .1"/><site name="mark" pos="0 0 1"/>
    <body name="ball" pos="2 0 1"><freejoint/><geom size=".1"/></body>
    <body name="upper" pos="0 0 1"><joint name="a" axis="0 1 0" range="-60 60" damping="1"/>
      <geom type="capsule" size=".05" fromto="0 0 0 .4 0 0"/><site name="tip"/>
      <body name="lower" pos=".4 0 0"><joint name="b" axis="0 1 0"/>
        <geom type="capsule" size=".05" fromto="0 0 0 .4 0 0"/></body></body></worldbody>
  <tendon><fixed name="t" limited="true" range="-1 1"><joint joint="a" coef="1"/>
    <joint joint="b" coef="-1"/></fixed></tendon>
  <contact><exclude body1="upper" body2="lower"/></contact>
  <actuator><motor name="m" joint="a" ctrlrange="-1 1" ctrllimited="true"/></actuator>
  <keyframe><key name="up" qpos="2 0 1 1 0 0 0 .5 0"/></keyframe>
</mujoco>"""
PEER = """#!/bin/sh
if [ "$1" = --list ]; then echo ball2d; exit; fi
poses=0,9,0
for i in $(seq 127); do poses="$poses,0,9,0"; done
echo '{"engine": "Good", "version": "1", "scene": "ball2d", "world_steps_per_s": 1000, "poses": ['$poses]}
"""


def sections():
    """Heading -> {key: (type, meaning)}."""
    found, keys = {}, None
    for line in DOCUMENT.read_text().splitlines():
        if line.startswith("## "):
            keys = found.setdefault(line[3:], {})
        elif match := ROW.match(line):
            assert match[1] not in keys, line
            keys[match[1]] = match[2].strip(), match[3].strip()
    return found


def type_of(value):
    for kind, name in ((bool, "boolean"), (int, "integer"), (float, "number"), (str, "text"),
                       (dict, "object"), (type(None), "null")):
        if isinstance(value, kind):
            return name
    of = {type_of(one) for one in value}
    if of <= {"integer", "number", "null"} and of:
        return "list of numbers"
    return {frozenset(): "empty list", frozenset({"text"}): "list of texts",
            frozenset({"object"}): "list of objects"}.get(frozenset(of), f"list of {sorted(of)}")


def fits(found, documented):
    allowed = documented.split(" or ")
    return (found in allowed or (found == "integer" and "number" in allowed)
            or (found == "empty list" and any(a.startswith("list") for a in allowed))
            # A number that happens to be infinite.
            or (found == "null" and "number" in allowed))


def walk(value, path=""):
    """(path, value) of everything below."""
    if isinstance(value, dict):
        for key, one in value.items():
            here = f"{path}.{key}" if path else key
            yield here, one
            yield from walk(one, here)
    elif isinstance(value, list):
        for one in value:
            if isinstance(one, dict):
                yield from walk(one, path + "[]")


class Keys(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.documented = sections()
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        (cls.folder / "model.xml").write_text(MODEL)
        (cls.folder / "page.html").write_text(
            '<meta name="manyworlds-page" content="1"><!-- manyworlds: recordings -->'
            "<!-- connect-src blob: -->")
        (cls.folder / "peers").mkdir()
        (cls.folder / "peers/peer_good").write_text(PEER)
        (cls.folder / "peers/peer_good").chmod(0o755)
        cls.info = cls.run_json("info")

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def start(cls, *arguments):
        environment = {**os.environ, "MANYWORLDS_VIEWER": str(cls.folder / "page.html")}
        return subprocess.Popen([PROGRAM, *arguments, "--json"], cwd=cls.folder, env=environment,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    @classmethod
    def run_json(cls, *arguments, codes=(0,)):
        process = cls.start(*arguments)
        out, errors = process.communicate()
        assert process.returncode in codes, (arguments, process.returncode, errors)
        return json.loads(out)

    def interrupted(self, *arguments, after=1.0):
        process = self.start(*arguments)
        time.sleep(after)
        process.send_signal(signal.SIGINT)
        out, errors = process.communicate()
        self.assertEqual(process.returncode, 130, errors)
        self.assertTrue(out, f"{arguments} printed nothing")
        return json.loads(out)

    def check(self, section, *outputs, whole=True):
        """The outputs have only documented keys, and together all those without "only"."""
        keys = self.documented[section]
        seen = set()
        for output in outputs:
            found = list(walk(output, "")) or []
            for path, value in found:
                documented = path if path in keys else next(
                    (key for key in keys if key.endswith(".*") and path.startswith(key[:-1])), path)
                self.assertIn(documented, keys, f"{section}: {path} is not documented")
                self.assertTrue(fits(type_of(value), keys[documented][0]),
                                f"{section}: {path} is {type_of(value)} ({str(value)[:80]}), "
                                f"documented as {keys[documented][0]}")
                seen.add(documented)
        missing = {key for key, (_, meaning) in keys.items() if "only" not in meaning} - seen
        if whole:
            self.assertFalse(missing, f"{section}: documented, but not printed")
        return seen

    def test_every_command_with_json_is_documented(self):
        def commands(*path):
            text = subprocess.run([PROGRAM, *path, "--help"], capture_output=True, text=True,
                                  check=True).stdout
            if "--json" in text:
                yield " ".join(path)
            if "Subcommands:" in text:
                for name in re.findall(r"(?m)^  (\w+) ", text.split("Subcommands:")[1].split("\n\n")[0]):
                    yield from commands(*path, name)

        found = list(commands())
        self.assertGreaterEqual(len(found), 15)
        self.assertLessEqual(set(found), set(self.documented))

    def test_lists(self):
        self.check("scenes", self.run_json("scenes"))
        self.check("info", self.info)
        self.check("info --options", self.run_json("info", "--options"))

    def test_run_and_bench(self):
        one = self.run_json("run", "stack10", "--worlds", "8", "--steps", "5")
        cut = self.interrupted("run", "stack10", "--worlds", "8", "--steps", "1000000000")
        self.assertIn("interrupted", self.check("run", one, cut))
        rows = self.run_json("bench", "--scenes", "ball3d", "--worlds", "8", "--steps", "5",
                             "--warm-up", "1", "--repeats", "1")
        self.check("run", *rows)
        rows = self.interrupted("bench", "--scenes", "ball3d", "--worlds", "8", "--steps", "100000000")
        self.assertEqual(list(rows[-1]), ["interrupted"])

    def test_plan(self):
        self.check("plan", *(self.run_json("plan", scene) for scene in ("stack10", "chain3d")))

    def test_model(self):
        outputs = [self.run_json("model", scene) for scene in ("ant", "lunar-lander")]
        if self.info["mjcf"]:
            outputs.append(self.run_json("model", "model.xml"))
            seen = self.check("model", *outputs)
            self.assertEqual(seen, set(self.documented["model"]))
        self.check("model", *outputs, whole=self.info["mjcf"])

    def test_compare(self):
        if not self.info["mjcf"]:
            self.skipTest("built without MuJoCo")
        process = self.start("compare", "model.xml", "--worlds", "4", "--steps", "3")
        out, errors = process.communicate()
        if "float64" in errors:
            self.skipTest("built without float64")
        self.assertIn(process.returncode, (0, 1), errors)
        self.check("compare", json.loads(out))

    def test_verify(self):
        process = self.start("verify", "--quick", "--scenes", "ball3d")
        out, errors = process.communicate()
        if "no kernels in f64" in errors:
            self.skipTest("built without float64")
        self.assertEqual(process.returncode, 0, errors)
        self.check("verify", json.loads(out))

    def test_soak(self):
        good = self.run_json("soak", "ball3d", "--worlds", "8", "--steps", "5")
        lost = self.run_json("soak", "ball3d", "--worlds", "8", "--steps", "5", "--dt", "1e30", codes=(1,))
        cut = self.interrupted("soak", "ball3d", "--worlds", "8", "--steps", "1000000000")
        self.assertEqual(lost["lost_worlds"] + lost["diverged_worlds"], 8)
        self.assertEqual(good["worlds_done"], 8)
        self.assertEqual(cut["worlds_done"], 0)
        self.assertEqual(self.check("soak", good, lost, cut), set(self.documented["soak"]))

    def test_recordings_and_pages(self):
        if not self.info["recordings"]:
            self.skipTest("built without recordings")
        self.run_json("run", "ball3d", "--worlds", "4", "--steps", "5", "--record", "run.h5")
        self.check("replay", self.run_json("replay", "run.h5"))
        self.check("view", self.run_json("view", "run.h5", "--out", "out.html"))

    def test_live_page(self):
        process = self.start("view", "ball3d", "--live", "--worlds", "2")
        lines = []
        for line in process.stdout:
            lines.append(line)
            if line == "}\n":
                break
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate()
        if not lines:
            self.assertEqual(process.returncode, 2, errors)
            self.skipTest("built without live pages")
        self.check("view --live", json.loads("".join(lines)))

    def test_reports(self):
        for name, arguments in {
            "accuracy": ("--cases", "A1,A16"),
            "stability": ("--cases", "B9"),
            "invariants": ("--families", "energy", "--kinds", "1"),
            "plan": ("--scenes", "ball2d"),
            "throughput": ("--scenes", "ball2d", "--peers", "peers", "--peers-only"),
        }.items():
            with self.subTest(name):
                process = self.start("report", name, "--quick", *arguments)
                out, errors = process.communicate()
                if "no reports" in errors or "MW_REPORT" in errors or "no kernels in f64" in errors:
                    self.skipTest("built without reports or without float64")
                self.assertEqual(process.returncode, 0, errors)
                whole = json.loads(out)
                results = whole.pop("results")
                self.check("report", {**whole, "results": []})
                # Without sweeps there are no rows.
                self.check(f"report {name}", results, whole=name != "throughput")
                if name == "invariants" and self.info["recordings"]:
                    command = shlex.split(results[0]["command"])
                    self.check("report invariants --world", self.run_json(*command[1:]))


if __name__ == "__main__":
    unittest.main()
