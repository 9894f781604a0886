#!/usr/bin/env python3
"""tools/scripts/tables on small reports of every name."""

import importlib.machinery
import importlib.util
import pathlib
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def load():
    loader = importlib.machinery.SourceFileLoader("tables", str(ROOT / "tools/scripts/tables"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("tables", loader))
    loader.exec_module(module)
    return module


tables = load()


def rows(text, start):
    """The cells of the rows that start with this."""
    return [line[2:-2].split(" | ") for line in text.splitlines() if line.startswith(f"| {start}")]


def verdict(case, setting, value, passed, **more):
    return {"id": case, "title": "cubes", "group": "sizes", "criterion": "moved", "unit": "m",
            "limit": 0.1, "setting": setting, "value": value, "lost_worlds": 0, "passed": passed,
            "note": "", **more}


def variant(scene, name, ratio, same=True, must=True, **more):
    return {"scene": scene, "variant": name, "world_steps_per_s": 2e6, "time_ratio": ratio,
            "same_bits": same, "must_be_same": must, **more}


class Numbers(unittest.TestCase):
    def test_have_two_or_three_digits(self):
        for value, text in ((0.064, "0.064"), (9.8e-5, "9.8e-5"), (322, "320"), (7.1e6, "7.1e6"),
                            (3e-10, "3e-10"), (0, "0"), (None, "lost")):
            self.assertEqual(tables.short(value), text)
        self.assertEqual([tables.whole(v) for v in (6.704, 22123.4)], ["6.7", "22100"])


class Table(unittest.TestCase):
    def test_bars_in_cells_do_not_end_them(self):
        self.assertEqual(tables.table(["a", "b:"], [["|v|", "1"]]),
                         "| a | b |\n| --- | ---: |\n| \\|v\\| | 1 |\n")


class Accuracy(unittest.TestCase):
    def test_both_precisions_share_a_cell(self):
        points = [{"method": "verlet", "precision": precision, "step_s": step, "error": error,
                   "us_per_world": 2 / step}
                  for precision in ("f32", "f64")
                  for step, error in ((0.1, None), (0.05, 3), (0.02, 0.01), (0.01, 2), (0.005, 1))]
        text = tables.accuracy([{
            "id": "A1", "title": "orbit", "metric": "distance", "unit": "m", "simulated_s": 10,
            "level": 0.01, "cheapest_at_level": [], "points": points,
            "published": [{"engine": "ODE", "error": 3, "step_s": 0.001, "seconds": 0.5},
                          {"engine": "ODE", "error": 1, "step_s": 0.0001, "seconds": 0}]}])
        # Every second step length, and 2 us / 10 s = 200 ns for each step.
        self.assertEqual(rows(text, "case | method"), [
            ["case", "method", "100 ms", "20 ms", "5 ms", "f32, ns", "f64, ns"]])
        self.assertEqual(rows(text, "A1 | "), [
            ["A1", "verlet", "lost, lost", "0.01, 0.01", "1, 1", "200", "200"]])
        self.assertIn("ODE 3 at 1 ms (0.5 s), 1 at 0.1 ms.", text)


class Stability(unittest.TestCase):
    def test_families_show_their_worst_case_and_how_many_fail(self):
        text = tables.stability([
            verdict("C2 5 cm", "default", 0.01, True), verdict("C2 5 cm", "penalty", 0.3, False),
            verdict("C2 9 cm", "default", 0.02, True), verdict("C2 9 cm", "penalty", None, False),
            verdict("C3", "default", 0.04, True, title="the same", criterion="sunk", note="soft"),
            verdict("C3", "penalty", 0.06, True, title="the same", criterion="sunk", note="soft")])
        self.assertEqual(rows(text, "default"), [["default", "3/3", "3/3", ""]])
        self.assertEqual(rows(text, "penalty"), [["penalty", "1/3", "1/3", "C2 5 cm, C2 9 cm"]])
        self.assertEqual(rows(text, "C2"), [
            ["C2 (2 cases): cubes", "moved: 0.1 m", "0.02", "**not finite** (2 of 2)"]])
        self.assertEqual(rows(text, "C3"), [["C3: cubes", "sunk: 0.1 m", "0.04", "0.06"]])
        self.assertIn("- C3: soft.", text)


class Invariants(unittest.TestCase):
    def row(self, family, precision, share, worst, **more):
        return {"family": family, "law": "energy", "criterion": "gain", "unit": "J", "units": "earth",
                "precision": precision, "share": share, "worst": worst, "limit": 0.1,
                "required": True, "passed": share <= 0.001, **more}

    def test_settings_are_columns_and_too_many_broken_worlds_are_bold(self):
        text = tables.invariants([
            self.row("hit 2D", "f32", 0.125, 3), self.row("hit 2D", "f64", 0.0005, 0.2),
            self.row("pile", "f32", 0, 0.01, required=False), self.row("pile", "f64", 1, None, required=False)])
        self.assertEqual(rows(text, "energy"), [["energy", "0/1", "1/1"]])
        self.assertEqual(rows(text, "hit"), [["hit 2D", "gain: 0.1 J", "**12**", "0.05", "3"]])
        self.assertEqual(rows(text, "pile"), [
            ["pile (not required)", "gain: 0.1 J", "0", "**100**", "not finite"]])


class Plan(unittest.TestCase):
    def test_scenes_are_columns(self):
        text = tables.plan([
            variant("a", "with drag", 1.014), variant("a", "in space", 2, same=False, must=False),
            variant("b", "with drag", 1.2, same=False), variant("b", "dense", 1),
            variant("bin:4", "sparse against all pairs", 7.5),
            variant("bin:8", "sparse against all pairs", 2),
            variant("B2", "4 substeps instead of 9", 0.5, same=False, must=False),
            variant("chain", "tree", 2, holds="gap 1 %")])
        self.assertEqual(rows(text, "with drag"), [["with drag", "1.01", "1.20 DIFFERENT"]])
        self.assertEqual(rows(text, "in space"), [["in space", "2.00*", ""]])
        self.assertEqual(rows(text, "bin | "), [["bin", "4", "8"]])
        self.assertEqual(rows(text, "sparse"), [["sparse against all pairs", "7.50", "2.00"]])
        self.assertEqual(rows(text, "B2"), [["B2", "4 substeps instead of 9", "2 M", "0.50*"]])
        self.assertEqual(rows(text, "tree"), [["tree", "2.00", "gap 1 %"]])


class Throughput(unittest.TestCase):
    def row(self, sweep, value, scene, speed, **more):
        return {"sweep": sweep, "value": value, "scene": scene, "worlds": 16, "threads": 1,
                "world_steps_per_s": speed, "body_steps_per_s": 2 * speed, "bytes_per_world": 80,
                "bandwidth_share": 0.5, "hash": "aa", **more}

    def test_sweeps_are_matrices_and_hashes_must_agree(self):
        isa = "instruction set and precision"
        text = tables.throughput({
            "gflops": 100, "gigabytes_per_s": 20, "peer_means": {"ratio": 3, "long_visit": None},
            "rows": [self.row("worlds", 16, "a", 2e6), self.row("worlds", 64, "a", 3e6),
                     self.row("worlds", 16, "b", 4e6), self.row("worlds", 64, "b", 5e6),
                     self.row(isa, "avx2 f32", "a", 1e6),
                     self.row(isa, "avx512 f32", "a", 1e6, hash="bb"),
                     self.row(isa, "avx2 f32", "b", 1e6), self.row(isa, "avx512 f32", "b", 1e6)],
            "peers": [{"scene": "a", "world_steps_per_s": 2e6, "long_visit": 3e6,
                       "worst_overlap_m": 0.001, "worst_gap_m": None,
                       "engines": [{"engine": "E", "version": "1", "world_steps_per_s": 1e6,
                                    "ratio": 2, "long_visit": None, "worst_overlap_m": None,
                                    "worst_gap_m": 0.02}]}]})
        self.assertEqual(rows(text, "16"), [["16", "2 M", "4 M"]])
        self.assertEqual(rows(text, "a | 80"), [["a", "80", "", "50 %", "DIFFERENT", ""]])
        self.assertEqual(rows(text, "b | 80"), [["b", "80", "", "50 %", "aa", ""]])
        self.assertEqual(rows(text, "E 1"), [["E 1", "2 / -, 20 mm"]])
        self.assertIn("fastest engine: 3.", text)


if __name__ == "__main__":
    unittest.main()
