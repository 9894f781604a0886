#!/usr/bin/env python3
"""What the documentation site makes of comments in headers and of docstrings; tools/docs builds all of it."""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs/site"))
import header_filter  # noqa: E402
import plain_text  # noqa: E402

HEADER = """// Joints: of two bodies.
//
// More.
#pragma once

// ---- a heading
// A limit, of `x` < 2 m:
//   low <= x
//   x <= high
struct Limit {
  double low = 0;  // m, Vector<double>
  const char* text = "//";
};
""".splitlines()


class Headers(unittest.TestCase):
    def setUp(self):
        self.filtered = list(header_filter.filtered(HEADER))

    def test_lines_keep_their_numbers(self):
        self.assertEqual(len(self.filtered), len(HEADER) + 1)  # and the end of the last line
        for number, line in enumerate(HEADER):
            if "//" not in line:
                self.assertEqual(self.filtered[number], line)

    def test_comments_are_doxygens(self):
        self.assertEqual(self.filtered[6], r"/// A limit, of <code>x</code> \< 2 m:")
        self.assertEqual(self.filtered[7:9], [r"/// \verbatim   low <= x", r"///   x <= high \endverbatim"])
        self.assertEqual(self.filtered[10], r"  double low = 0;  ///< m, Vector\<double\>")

    def test_headings_and_texts_are_none(self):
        self.assertEqual(self.filtered[5], HEADER[5])
        self.assertEqual(self.filtered[11], HEADER[11])

    def test_the_comment_at_the_top_is_the_pages(self):
        self.assertEqual(header_filter.top_comment(HEADER), ["Joints: of two bodies.", "", "More."])
        self.assertEqual(self.filtered[:3], [""] * 3)

    def test_every_public_header_has_one(self):
        for header in (ROOT / "include/manyworlds").glob("*.hpp"):
            with self.subTest(header=header.name):
                lines = header.read_text(encoding="utf-8").splitlines()
                self.assertTrue(header_filter.top_comment(lines))


class PlainText(unittest.TestCase):
    def test_columns_stay_and_the_rest_flows(self):
        text = "One line\nand another.\n\nscene    a Scene\nworlds   how many\n\nThe end:\n    x = 1\n"
        self.assertEqual(plain_text.markdown(text),
                         ["One line\nand another.", "", "~~~text", "scene    a Scene", "worlds   how many", "~~~", "",
                          "The end:", "", "~~~text", "    x = 1", "~~~", ""])

    def test_marks_outside_of_code_are_characters(self):
        self.assertEqual(plain_text.markdown("a_b * ``c_d`` <e>")[0], r"a\_b \* `c_d` \<e>")


if __name__ == "__main__":
    unittest.main()
