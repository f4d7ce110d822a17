# SPDX-License-Identifier: Apache-2.0
"""vmcost on the command line.

Run as cli_test.py is."""
import csv
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest

from case import BIN, CONFIG, QUAD, QUAD_WITHOUT_UV, Case

SMALL = ["--quick", "--resolution", "16", "--reference-samples", "8", "--no-plots"]
# A floor with a wall on it, which casts.
STEP = ("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 1 -1 1\nv 1 1 1\n"
        "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 0.5 0\nvt 1 0\nvt 1 1\nvt 0.5 1\nvn 0 0 1\nvn -1 0 0\n"
        "f 1/1/1 2/2/1 3/3/1 4/4/1\nf 2/5/2 5/6/2 6/7/2 3/8/2\n")


class Cost(Case):
    def setUp(self):
        super().setUp()
        self.file("step.obj", STEP)
        self.sky(1, 2, 3)
        self.oiiotool("--pattern", "checker:width=8:height=4:color1=1,.5,.2:color2=.1,.3,2", "64x32", "3", "-d", "float",
                      "-o", "checker.exr")

    def cost(self, *words, said=True):
        out = self.done("vmcost", "step.obj", *words, "-o", "report")
        if said:
            self.measured, self.reused = map(int, re.search(r"measured (\d+) rows?, reused (\d+)", out).groups())
        return out

    def rows(self):
        with open(self.path("report/costs.json")) as file:
            return json.load(file)["rows"]

    def names(self):
        return sorted(os.listdir(self.path("report")))

    def test_wrong_usage_is_refused_before_anything_is_made(self):
        sky = ["step.obj", "sky.exr"]
        self.refused(2, "-o FOLDER is missing", "vmcost", *sky)
        self.refused(2, "ENVIRONMENT... is missing", "vmcost", "step.obj", "-o", "report")
        self.refused(2, 'unknown flag "--resolutions"; did you mean --resolution?', "vmcost", *sky, "-o", "report",
                     "--resolutions", "8")
        self.refused(2, 'resolution: 7 is not in [8, 4096] or "auto"', "vmcost", *sky, "-o", "report", "--resolution", "7")
        self.refused(2, 'unknown flag "--format"', "vmcost", *sky, "-o", "report", "--format", "half")
        self.file("file")
        self.refused(1, '"file": is a file, not a folder', "vmcost", *sky, "-o", "file")
        self.refused(1, '"a/b": no folder "a"', "vmcost", *sky, "-o", "a/b")
        self.refused(1, 'the folder "/proc" cannot be written', "vmcost", *sky, "-o", "/proc/report")
        help_text = self.done("vmcost", "--help")
        self.assertIn("vmcost MESH ENVIRONMENT... -o FOLDER", help_text)
        self.assertNotIn("RECIPE", help_text)

    def test_inputs_that_are_not_what_they_should_be_are_refused(self):
        end = ["-o", "report", *SMALL]
        self.refused(1, '"no.obj": no such file', "vmcost", "no.obj", "sky.exr", *end)
        self.refused(1, '"no.exr": no such file', "vmcost", "step.obj", "sky.exr", "no.exr", *end)
        self.file("bare.obj", QUAD_WITHOUT_UV)
        self.refused(1, "texture coordinates", "vmcost", "bare.obj", "sky.exr", *end)
        self.refused(1, '"vm.exr": neither an environment nor a CFEM', "vmcost", "step.obj", self.vismap(), *end)

    def test_bad_pixels_are_refused_and_mended_when_asked(self):
        self.oiiotool("sky.exr", "--subc", "2", "-o", "negative.exr")
        result = self.run_tool("vmcost", "step.obj", "negative.exr", "-o", "report", *SMALL)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r'^vmcost ERROR: "negative.exr": .*sanitize')
        self.cost("negative.exr", "--sanitize", *SMALL)

    def test_a_dark_environment_and_a_tiny_mesh_are_told(self):
        self.sky(0, 0, 0, name="black.exr")
        result = self.run_tool("vmcost", "step.obj", "black.exr", "-o", "report", *SMALL)
        self.assertEqual((result.returncode, result.stderr),
                         (1, 'vmcost ERROR: "black.exr": no light falls on the mesh\n'))
        self.file("tiny.obj", QUAD.replace("vt 1", "vt 0.1").replace("vt 0 1", "vt 0 0.1").replace("vt 0.1 1", "vt 0.1 0.1"))
        result = self.run_tool("vmcost", "tiny.obj", "sky.exr", "-o", "report", *SMALL)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, "the mesh covers [0-9]+ of 16x16 texels, of which 64 are needed: raise resolution")

    def test_light_on_a_single_texel_is_refused(self):
        # A floor, and a speck of one texel that looks the other way, where all the light is.
        self.file("speck.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 5 0 0\nv 5 1 0\nv 6 1 0\nv 6 0 0\n"
                  "vt 0 0\nvt 0.8 0\nvt 0.8 1\nvt 0 1\nvt 0.94 0\nvt 0.94 0.06\nvt 1 0.06\nvt 1 0\nvn 0 0 1\nvn 0 0 -1\n"
                  "f 1/1/1 2/2/1 3/3/1 4/4/1\nf 5/5/2 6/6/2 7/7/2 8/8/2\n")
        self.oiiotool("--pattern", "constant:color=0,0,0", "64x32", "3", "--fill:color=1,1,1", "4x32+0+0", "-d", "float",
                      "-o", "back.exr")
        result = self.run_tool("vmcost", "speck.obj", "back.exr", "-o", "report", *SMALL)
        self.assertEqual((result.returncode, result.stderr), (
            1, 'vmcost ERROR: "back.exr": light falls on too few texels to tell an error: raise resolution\n'))

    def test_gnuplot_is_asked_for_before_the_work(self):
        path = self.environment["PATH"]
        os.mkdir(self.path("empty"))
        self.environment["PATH"] = self.path("empty")
        self.refused(1, "gnuplot is missing: install the package gnuplot-nox", "vmcost", "step.obj", "sky.exr", "-o",
                     "report", *SMALL[:-1])
        self.cost("sky.exr", *SMALL)
        self.assertFalse([name for name in self.names() if name.endswith(".svg")])
        self.environment["PATH"] = path

    def test_the_report_says_what_its_tables_say_and_fetches_nothing(self):
        if not shutil.which("gnuplot"):
            self.skipTest("gnuplot is not installed")
        out = self.cost("sky.exr", "checker.exr", *SMALL[:-1])
        rows = self.rows()
        self.assertEqual((self.measured, self.reused), (len(rows), 0))
        table = list(csv.DictReader(io.StringIO(self.read("report/costs.csv").decode())))
        self.assertEqual(len(table), len(rows))
        for line, row in zip(table, rows):
            self.assertEqual(list(line), list(row))
            for name, value in row.items():
                if isinstance(value, float):
                    self.assertAlmostEqual(float(line[name]), value, delta=1e-5 * abs(value))
                else:
                    self.assertEqual(line[name], str(value))
            self.assertLessEqual(row["rmse_low"], row["rmse"])
            self.assertLessEqual(row["rmse"], row["rmse_high"])
            self.assertGreater(row["shade_seconds"], 0)
        self.assertEqual({row["environment"] for row in rows}, {"sky", "checker"})
        page = self.read("report/report.html").decode()
        self.assertTrue(page.startswith("<!DOCTYPE html>"))
        self.assertEqual(page.count("<svg"), 3)
        self.assertEqual(page.count("data:image/png;base64,"), 2 * len({row["model"] for row in rows}))
        for found in re.findall(r"""(?:src|href)=["']?([^"' >]*)""", page):
            self.assertRegex(found, "^(data:|#)", "nothing is fetched")
        self.assertNotIn("@import", page)
        self.assertIn("10.0 %: ", out)
        for name in "error_time", "error_bytes", "error_rays":
            self.assertEqual(self.read(f"report/{name}.png")[1:4], b"PNG")
            self.assertIn(b"<svg", self.read(f"report/{name}.svg"))
        self.oiiotool("report/error_sky_lobe.exr", "report/error_sky_lobe.png")
        self.assertFalse([name for name in self.names() if name.startswith(".")], "debris")

    def test_all_models_are_exact_under_constant_light(self):
        self.cost("sky.exr", *SMALL, "--reference-samples", "512")
        best = {}
        for row in self.rows():
            if row["samples"] == 256 or row["model"] == "traced":
                best[row["model"]] = row
        for model in "ao", "paper", "lobe":
            self.assertLess(best[model]["rmse"], 0.03, model)
            self.assertLess(abs(best[model]["bias"]), 0.01, model)

    def test_rows_are_measured_once_and_anew_when_an_input_changes(self):
        self.cost("checker.exr", *SMALL)
        count, before = self.measured, self.rows()
        self.cost("checker.exr", *SMALL)
        self.assertEqual((self.measured, self.reused), (0, count))
        self.assertEqual(self.rows(), before)
        self.cost("checker.exr", "sky.exr", *SMALL)
        self.assertEqual((self.measured, self.reused), (count, count))
        self.file("roof.obj", QUAD.replace(" 0\nv", " 0.5\nv"))
        for words in ["--resolution", "17"], ["--occluder", "roof.obj"], ["--up", "z"]:
            self.cost("checker.exr", *SMALL, *words)
            self.assertEqual((self.measured, self.reused), (count, 0), words)
        self.sky(3, 2, 1, name="checker.exr")
        self.cost("checker.exr", *SMALL)
        self.assertEqual((self.measured, self.reused), (count, 0), "another picture of the same name")

    def test_a_lost_heat_map_is_made_again(self):
        self.cost("sky.exr", *SMALL)
        count = self.measured
        os.remove(self.path("report/error_sky_paper.exr"))
        os.remove(self.path("report/error_sky_lobe.png"))
        self.cost("sky.exr", *SMALL)
        self.assertEqual((self.measured, self.reused), (2, count - 2))

    def test_the_same_pixels_in_another_frame_are_another_light(self):
        even = ["--pattern", "constant:color=1,2,3"]
        self.oiiotool(*even, "8x4", "3", "-d", "float", "-o", "sky.exr")
        self.cost("sky.exr", *SMALL)
        count = self.measured
        for other in ["4x8", "3", "-o"], ["8x4", "3", "--fullsize", "16x4+0+0", "-o"], ["8x4", "3", "-oenv"]:
            self.oiiotool(*even, *other[:-1], "-d", "float", other[-1], "sky.exr")
            self.cost("sky.exr", *SMALL)
            self.assertEqual((self.measured, self.reused), (count, 0), other)

    def test_files_of_a_report_that_are_not_what_they_were_are_made_again(self):
        self.cost("checker.exr", *SMALL)
        count, before = self.measured, self.read("report/error_checker_lobe.exr")
        self.file("report/error_checker_lobe.exr", before[:-40])
        out = self.cost("checker.exr", *SMALL)
        self.assertIn("checker: reused the reference", out)
        self.assertEqual((self.measured, self.reused), (1, count - 1))
        self.assertEqual(self.read("report/error_checker_lobe.exr"), before)
        reference, = [name for name in self.names() if name.startswith("reference_")]
        traced = self.read("report/" + reference)
        for spoil in ["--resize", "8x8"], ["--crop", "16x8+0+0"]:
            self.oiiotool("report/" + reference, *spoil, "-o", "report/" + reference)
            self.assertNotIn("reused the reference", self.cost("checker.exr", *SMALL))
            self.assertEqual(self.read("report/" + reference), traced)
        self.file("report/" + reference, traced[:-40])
        self.assertNotIn("reused the reference", self.cost("checker.exr", *SMALL))
        self.assertEqual(self.read("report/" + reference), traced)

    CUT_SHORT = ["--quick", "--resolution", "64", "--reference-samples", "16", "--no-plots"]

    def interrupted(self, number):
        words = [os.path.join(BIN, "vmcost"), "step.obj", "checker.exr", "-o", "report", *self.CUT_SHORT, "--quiet"]
        process = subprocess.Popen(words, cwd=self.folder, stderr=subprocess.PIPE, text=True)
        journal = self.path("report/journal.jsonl")
        until = time.monotonic() + 60
        while not (os.path.exists(journal) and os.path.getsize(journal) > 1000):
            self.assertIsNone(process.poll())
            self.assertLess(time.monotonic(), until)
            time.sleep(0.01)
        process.send_signal(number)
        sent = time.monotonic()
        _, error = process.communicate(timeout=60)
        return process.returncode, error, time.monotonic() - sent

    def test_a_run_that_is_cut_short_goes_on_where_it_stopped(self):
        code, error, took = self.interrupted(signal.SIGINT)
        self.assertEqual((code, error), (1, "vmcost ERROR: interrupted\n"))
        self.assertLess(took, 1)
        self.assertFalse([name for name in self.names() if name.startswith(".")], "debris")
        kept = self.read("report/journal.jsonl").count(b"\n")
        self.assertGreaterEqual(kept, 2)
        code, _, _ = self.interrupted(signal.SIGKILL)
        self.assertEqual(code, -signal.SIGKILL)
        with open(self.path("report/journal.jsonl"), "ab") as journal:
            journal.write(b'{"key": "torn", "environment": "che')
        out = self.cost("checker.exr", *self.CUT_SHORT)
        self.assertIn("checker: reused the reference", out)
        self.assertGreaterEqual(self.reused, kept)
        self.assertGreater(self.measured, 0)
        self.assertEqual(self.measured + self.reused, len(self.rows()))

    def test_errors_are_the_same_for_any_number_of_threads(self):
        found = []
        for threads in "1", "2":
            self.cost("checker.exr", *SMALL, "--threads", threads)
            found.append([{name: value for name, value in row.items() if "seconds" not in name} for row in self.rows()])
        self.assertEqual(*found)

    def test_environments_become_scene_linear_and_names_stay_apart(self):
        os.mkdir(self.path("other"))
        self.sky(3, 1, 1, name="other/sky.exr")
        out = self.cost("sky.exr", "other/sky.exr", "--colorconfig", CONFIG, "--colorspace", "lin_rec709_scene", *SMALL)
        self.assertRegex(out, r"sky: 16x8, .* -> ACEScg")
        self.assertEqual({row["environment"] for row in self.rows()}, {"sky", "sky_2"})
        self.refused(1, "no_such_space", "vmcost", "step.obj", "sky.exr", "-o", "new", "--colorspace", "no_such_space",
                     "--colorconfig", CONFIG)

    def test_quiet_says_nothing(self):
        self.assertEqual(self.cost("sky.exr", *SMALL, "--quiet", said=False), "")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
