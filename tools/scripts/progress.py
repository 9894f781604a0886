#!/usr/bin/env python3
"""Builds a target and shows how far it is, with a rough time that is left.

    tools/scripts/progress.py NAME BUILD_DIR TARGET

On standard error: one line that is written over on a terminal, else a plain line now and then, each
with NAME in front. What compilers and CMake say passes through. Exit status: the build's own, or 130
when it was interrupted.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

# Relative costs of units, as measured: CPU seconds on an AMD EPYC of 2.6 GHz. The first match counts.
COSTS = [
    (r"kernels_(avx2|avx512)_f\d\d.*/(collide_(planar|spatial)|build_|solver_)", 12.0),
    (r"kernels_(avx2|avx512)_f\d\d.*/(flight_spatial|joints_tensor)", 9.0),
    (r"kernels_scalar_f\d\d.*/(collide_(planar|spatial)|build_|solver|flight|joints_tensor)", 4.0),
    (r"kernels_.*/(flight|joints|table|observe|sweeps|cmake_pch)", 3.0),
    (r"kernels_", 0.8),
    (r"/unity_(scene|plan|api|state)_", 14.0),
    (r"/unity_|cmake_pch", 7.0),
    (r"\.o$", 4.0),
]
EVERY = {True: 0.5, False: 15.0}  # s from one line to the next, on a terminal or not
STATUS = re.compile(r"^\[(\d+)/(\d+)\] (.*)$")


def cost_of(step):
    """Seconds of CPU time that a step of the build takes, as in "Building CXX object a/b.cpp.o"."""
    name = step.split(" ")[-1]
    return next((cost for pattern, cost in COSTS if re.search(pattern, name)), 0.5)


def text_of(seconds):
    """A rough time for people: "10 s", "1 min 20 s", "7 min"."""
    seconds = max(5, 5 * round(seconds / 5)) if seconds < 60 else 10 * round(seconds / 10)
    minutes, rest = divmod(seconds, 60)
    if minutes == 0:
        return f"{rest} s"
    return f"{minutes} min" if rest == 0 or minutes >= 5 else f"{minutes} min {rest} s"


class Estimate:
    """What is left of a list of steps, from their costs and the pace so far."""

    def __init__(self, steps, cores):
        self.left = {}
        for step in steps:
            self.left[step] = self.left.get(step, 0) + cost_of(step)
        self.total = sum(self.left.values())
        self.pace = float(cores)  # cost per second, before anything is known

    def finish(self, step):
        self.left.pop(step, None)

    def seconds_left(self, elapsed):
        """After `elapsed` s; what was foretold weighs as much as the first 20 s of what was seen."""
        left = sum(self.left.values())
        seen = (self.total - left + 20 * self.pace) / (elapsed + 20)
        return left / seen


def steps_of(build_dir, target):
    """The steps that are to be done, or none where ninja cannot say."""
    def ninja(*arguments):
        return subprocess.run(["ninja", "-C", build_dir, *arguments], stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, text=True, check=False)

    ninja("build.ninja")  # looks for new files
    # Of build.ninja itself a dry run only foretells that CMake would look for new files again.
    plan_file = pathlib.Path(build_dir, "progress.ninja")
    try:
        shutil.copyfile(pathlib.Path(build_dir, "build.ninja"), plan_file)
        plan = ninja("-f", plan_file.name, "-n", target)
    except OSError:
        return []
    finally:
        plan_file.unlink(missing_ok=True)
    return [m[3] for m in map(STATUS.match, plan.stdout.splitlines()) if m]


class Screen:
    """Standard error, with a line at its end that is written over where it is a terminal."""

    def __init__(self, name):
        self.name = name
        self.terminal = sys.stderr.isatty() and os.environ.get("TERM", "dumb") != "dumb"
        self.shown = False
        self.last = time.monotonic()

    def due(self):
        return time.monotonic() - self.last >= EVERY[self.terminal]

    def erase(self):
        if self.shown:
            sys.stderr.write("\r\033[K")
        self.shown = False

    def tell(self, text):
        self.erase()
        sys.stderr.write(f"{self.name}: {text}" + ("" if self.terminal else "\n"))
        sys.stderr.flush()
        self.shown = self.terminal
        self.last = time.monotonic()

    def passed(self, line):
        self.erase()
        sys.stderr.write(line)
        sys.stderr.flush()


def build(name, build_dir, target):
    cores = len(os.sched_getaffinity(0))
    steps = steps_of(build_dir, target)
    estimate = Estimate(steps, cores)
    screen = Screen(name)
    if len(steps) > 3:
        screen.tell(f"{len(steps)} steps to build, about {text_of(estimate.seconds_left(0))}")
    began = time.monotonic()
    command = ["cmake", "--build", build_dir, "--target", target, "--parallel", str(cores)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors="replace") as process:
        try:
            for line in process.stdout:
                status = STATUS.match(line)
                if not status:
                    if not line.startswith(("ninja: no work", "ninja: Entering")):
                        screen.passed(line)
                    continue
                estimate.finish(status[3])
                done, total = int(status[1]), int(status[2])
                if done < total and screen.due():
                    left = text_of(estimate.seconds_left(time.monotonic() - began))
                    screen.tell(f"{done} of {total} steps, about {left} left")
            code = process.wait()
        except KeyboardInterrupt:
            process.wait()
            code = 130
    screen.erase()
    return code


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    sys.exit(build(*sys.argv[1:]))
