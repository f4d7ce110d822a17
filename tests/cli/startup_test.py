# SPDX-License-Identifier: Apache-2.0
"""What is answered before anything is loaded: help, versions, completion and wrong usage; and `vmlight WORD`, which becomes
another executable.

Run as: startup_test.py [CASE ...], with VMLIGHT_BIN (the executables' folder) and VMLIGHT_SOURCE (the repository)."""
import glob
import os
import re
import shutil
import signal
import subprocess
import unittest

from case import BIN, SKY, SPOT, Case

WORK = os.path.join(BIN, "../libexec/vmlight")
OPERANDS = {"makevismap": ["a.obj"], "makecfem": ["a.exr"], "makelightmap": ["a.exr", "b.exr"], "vmframes": ["a.obj", "b.exr"],
            "vmcost": ["a.obj", "b.exr"], "vmexport": ["a.exr"], "vmview": ["a.obj", "b.exr"]}
TOOLS = [tool for tool in OPERANDS if os.path.exists(os.path.join(BIN, tool))]  # vmview, where its libraries are
WORDS = {"bake": "makevismap", "filter": "makecfem", "light": "makelightmap", "frames": "vmframes", "view": "vmview",
         "cost": "vmcost", "export": "vmexport"}
NUMBER = {"makevismap": ["--samples", "0"], "makecfem": ["--order", "-1"], "makelightmap": ["--bounce-albedo", "2"],
          "vmframes": ["--samples", "0.5"], "vmcost": ["--reference-samples", "none"], "vmexport": ["--for", "doom"],
          "vmview": ["--show", "nothing"]}


class Startup(Case):
    def loaded(self, *words):
        """The names of all libraries that a command loads, and its result."""
        debug = dict(self.environment, LD_DEBUG="libs", LD_DEBUG_OUTPUT=self.path("ld"))
        result = subprocess.run([os.path.join(BIN, words[0]), *words[1:]], capture_output=True, text=True, cwd=self.folder,
                                env=debug, timeout=120)
        names = set()
        for path in glob.glob(glob.escape(self.folder) + "/ld.*"):
            with open(path, errors="replace") as file:
                names |= {os.path.basename(name) for name in re.findall(r"calling init: (\S+)", file.read())}
            os.remove(path)
        if not names:
            self.skipTest("this system's loader does not say what it loads")
        return names, result

    def assert_light(self, code, *words):
        names, result = self.loaded(*words)
        self.assertEqual(result.returncode, code, (words, result.stderr))
        heavy = [name for name in names if re.search("OpenImageIO|OpenColorIO|OpenEXR|embree|assimp", name)]
        self.assertEqual(heavy, [], words)
        self.assertLess(len(names), 16, (words, names))
        return result

    def test_answers_load_none_of_what_makes_images(self):
        for tool in TOOLS:
            for flag in "--help", "--version", "--print-man":
                self.assertTrue(self.assert_light(0, tool, flag).stdout)
            for shell in "bash", "zsh":
                self.assert_light(0, tool, "--print-completion", shell)
            self.assertIn("unknown flag", self.assert_light(2, tool, "--nonsense").stderr)
            if tool != "vmview":  # whose window opens without a mesh
                self.assertIn("is missing", self.assert_light(2, tool).stderr)
            self.assertIn("needs a value", self.assert_light(2, tool, *OPERANDS[tool], "-o").stderr)
            self.assertRegex(self.assert_light(2, tool, *OPERANDS[tool], *NUMBER[tool], "-o", "x").stderr,
                             "ERROR: --[a-z-]+: .* is not ")
            if tool not in ("vmexport", "vmview"):
                self.assertIn("-o ", self.assert_light(2, tool, *OPERANDS[tool]).stderr)
        for words in ["--help"], ["--version"], ["help"], ["help", "bake"], ["bake", "--help"], ["light", "--version"]:
            self.assert_light(0, "vmlight", *words)
        for words in [], ["bakes"], ["--nonsense"], ["help", "bakes"], ["filter", "--nonsense"]:
            self.assert_light(2, "vmlight", *words)

    def test_work_loads_it(self):
        names, result = self.loaded("makelightmap", "gone.exr", "gone.hdr", "-o", "x.exr")
        self.assertEqual(result.returncode, 1)
        self.assertTrue([name for name in names if name.startswith("libOpenImageIO.so")], names)

    def test_answers_are_those_of_what_works(self):
        """(Those of all but vmview, of whose main front_test.cpp has no copy, are compared there.)"""
        for tool in TOOLS:
            for words in [["--version"]] if tool != "vmview" else (
                          ["--help"], ["--version"], ["--print-man"], ["--print-completion", "bash"], ["--print-flags"],
                          ["--print-completion", "zsh"], ["--print-completion", "fish"], ["--help=x"], ["-h"], ["--"],
                          ["--nonsense"], ["--threads"], OPERANDS[tool], [*OPERANDS[tool], *NUMBER[tool], "-o", "x"],
                          [*OPERANDS[tool], "--threads", "many", "-o", "x"], [*OPERANDS[tool], "-o", ""],
                          [*OPERANDS[tool], "--samples", "8", "--sample", "8"]):
                run = [subprocess.run([os.path.join(folder, name), *words], capture_output=True, cwd=self.folder,
                                      env=self.environment, timeout=120)
                       for folder, name in ((BIN, tool), (WORK, tool + ".bin"))]
                self.assertEqual(run[0].stdout, run[1].stdout, (tool, words))
                self.assertEqual(run[0].stderr, run[1].stderr, (tool, words))
                self.assertEqual(run[0].returncode, run[1].returncode, (tool, words))

    def test_a_full_disk_is_an_error(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("no /dev/full")
        for tool in *TOOLS, "vmlight":
            with open("/dev/full", "w") as full:
                result = subprocess.run([os.path.join(BIN, tool), "--help"], stdout=full, stderr=subprocess.PIPE, text=True,
                                        timeout=120)
            self.assertEqual((result.returncode, result.stderr), (1, f"{tool} ERROR: cannot write to stdout\n"))

    def test_it_finds_what_works_through_links_and_says_if_that_is_gone(self):
        os.symlink(os.path.join(BIN, "makecfem"), self.path("linked"))
        result = subprocess.run(["other name", "gone.hdr", "-o", "x.exr"], executable=self.path("linked"),
                                capture_output=True, text=True, cwd=self.folder, timeout=120)
        self.assertEqual((result.returncode, result.stderr), (1, 'makecfem ERROR: "gone.hdr": no such file\n'))
        os.makedirs(self.path("alone/bin"))
        shutil.copy(os.path.join(BIN, "makecfem"), self.path("alone/bin"))
        result = subprocess.run([self.path("alone/bin/makecfem"), "gone.hdr", "-o", "x.exr"], capture_output=True,
                                text=True, timeout=120)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r'makecfem ERROR: ".*libexec/vmlight/makecfem.bin": No such file')
        self.assertIn("install vmlight as a whole", result.stderr)

    def test_the_process_has_the_name_of_the_executable(self):
        process = subprocess.Popen([os.path.join(BIN, "makevismap"), SPOT, "-o", "x.exr", "--resolution", "4096",
                                    "--samples", "65536"], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        process.stderr.readline()  # the bake is under way
        with open(f"/proc/{process.pid}/comm") as file:
            self.assertEqual(file.read(), "makevismap\n")
        process.kill()
        process.communicate(timeout=300)


class OneCommand(Case):
    def test_each_word_is_an_executable(self):
        help_text = self.done("vmlight", "--help")
        for word, tool in WORDS.items():
            self.assertRegex(help_text, rf"(?m)^  {word} +{tool} ")
            if tool in TOOLS:
                expected = self.done(tool, "--help")
                self.assertEqual(self.done("vmlight", word, "--help"), expected)
                self.assertEqual(self.done("vmlight", "help", word), expected)
        self.assertEqual(self.done("vmlight", "--version"), self.done("makevismap", "--version"))

    def test_arguments_exit_codes_and_signals_pass_through(self):
        self.vismap()
        self.done("vmlight", "light", "vm.exr", SKY, "-o", "a lit map.exr", "--rotate", "0,90,0")
        self.done("makelightmap", "vm.exr", SKY, "-o", "b.exr", "--rotate", "0,90,0")
        self.assertEqual(self.read("a lit map.exr"), self.read("b.exr"))
        for words, code, text in ((["bake"], 2, "makevismap ERROR: MESH is missing"),
                                  (["filter", "gone.hdr", "-o", "x.exr"], 1, 'makecfem ERROR: "gone.hdr": no such file')):
            result = self.run_tool("vmlight", *words)
            self.assertEqual(result.returncode, code)
            self.assertIn(text, result.stderr)
        for number, code in (signal.SIGTERM, 1), (signal.SIGKILL, -signal.SIGKILL):
            process = subprocess.Popen([os.path.join(BIN, "vmlight"), "bake", SPOT, "-o", "x.exr", "--resolution", "4096",
                                        "--samples", "65536"], cwd=self.folder, stderr=subprocess.PIPE, text=True)
            process.stderr.readline()  # the bake is under way
            process.send_signal(number)
            process.communicate(timeout=300)
            self.assertEqual(process.returncode, code)

    def test_refusals_name_the_nearest_and_all(self):
        self.refused(2, 'unknown command "bakes"; did you mean bake? commands: bake, filter, light, frames, view, cost, '
                     "export (see vmlight --help)", "vmlight", "bakes")
        self.refused(2, 'unknown command "zzz"; commands: bake', "vmlight", "zzz", "--help")
        self.refused(2, 'unknown command "bakes"', "vmlight", "help", "bakes")
        self.refused(2, "COMMAND is missing", "vmlight")
        self.refused(2, 'unknown flag "--hepl"; did you mean --help?', "vmlight", "--hepl")
        self.refused(2, '"fish" is not one of bash, zsh', "vmlight", "--print-completion", "fish")

    def test_executables_are_beside_it_or_in_the_path(self):
        os.mkdir(self.path("bin"))
        shutil.copy(os.path.join(BIN, "vmlight"), self.path("bin"))
        words = [self.path("bin/vmlight"), "filter", "--version"]
        found = subprocess.run(words, capture_output=True, text=True, env=dict(self.environment, PATH=BIN), timeout=120)
        self.assertEqual((found.returncode, found.stdout), (0, self.done("makecfem", "--version")))
        lost = subprocess.run(words, capture_output=True, text=True, env=dict(self.environment, PATH="/nowhere"),
                              timeout=120)
        self.assertEqual(lost.returncode, 1)
        self.assertIn("it is neither beside vmlight nor in $PATH", lost.stderr)
        with open(self.path("bin/makecfem"), "w") as file:
            file.write("#!/bin/sh\necho beside\n")
        os.chmod(self.path("bin/makecfem"), 0o755)
        found = subprocess.run(words, capture_output=True, text=True, env=dict(self.environment, PATH=BIN), timeout=120)
        self.assertEqual(found.stdout, "beside\n")


if __name__ == "__main__":
    unittest.main()
