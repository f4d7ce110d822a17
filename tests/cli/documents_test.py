# SPDX-License-Identifier: Apache-2.0
"""Man pages and completion scripts, which the build made from the params of the executables.

Run as: documents_test.py, with VMLIGHT_BIN (the executables' folder) and VMLIGHT_SHARE (the documents' folder).
"""
import os
import re
import shutil
import subprocess
import sys
import unittest

BIN = os.environ["VMLIGHT_BIN"]
SHARE = os.environ["VMLIGHT_SHARE"]
TOOLS = ["makevismap", "makecfem", "makelightmap", "vmcost", "vmexport", "vmframes"]
if os.path.exists(os.path.join(BIN, "vmview")):  # where its libraries are installed
    TOOLS.append("vmview")


def path(kind, tool):
    return os.path.join(SHARE, {"man": f"man/man1/{tool}.1", "bash": f"bash-completion/completions/{tool}",
                                "zsh": f"zsh/site-functions/_{tool}"}[kind])


def text(kind, tool):
    with open(path(kind, tool)) as file:
        return file.read()


def output(*words):
    """What a program prints, which must end well."""
    result = subprocess.run(words, capture_output=True, text=True, timeout=60)
    assert result.returncode == 0, (words, result.stdout, result.stderr)
    return result.stdout + result.stderr


class Documents(unittest.TestCase):
    def test_every_flag_and_word_of_the_help_is_in_all_documents(self):
        for tool in TOOLS:
            lines = output(os.path.join(BIN, tool), "--help").splitlines()
            flags = [line.split()[0] for line in lines if re.match(r"  -", line)]
            words = [line.split()[0] for line in lines if re.match(r" {30}\S", line)]
            self.assertGreaterEqual(len(flags), 8, tool)
            self.assertIn("--help", flags)
            for kind in ("man", "bash", "zsh"):
                document = re.sub(r"\\f[BIR]", " ", text(kind, tool).replace("\\-", "-"))  # troff's fonts
                for name in flags + words:
                    self.assertRegex(document, r"(?<![\w-])" + re.escape(name) + r"(?![\w-])", (tool, kind))

    def test_lint_finds_nothing_in_man_pages(self):
        linters = {"groff": ["groff", "-man", "-ww", "-z"], "mandoc": ["mandoc", "-T", "lint", "-W", "warning"]}
        linters = {name: words for name, words in linters.items() if shutil.which(name)}
        if not linters:
            self.skipTest("neither groff nor mandoc is installed")
        for words in linters.values():
            result = subprocess.run([*words, *[path("man", tool) for tool in [*TOOLS, "vmlight"]]], capture_output=True, text=True,
                                    timeout=60)
            # They have no date, so that equal sources give equal bytes.
            found = [line for line in (result.stdout + result.stderr).splitlines() if "missing date" not in line]
            self.assertEqual(found, [])

    def test_shells_accept_the_completion_scripts(self):
        for tool in [*TOOLS, "vmlight"]:
            self.assertEqual(output("bash", "-n", path("bash", tool)), "")
        if not shutil.which("zsh"):
            self.skipTest("zsh is not installed: its scripts were not checked")
        for tool in [*TOOLS, "vmlight"]:
            self.assertEqual(output("zsh", "-n", path("zsh", tool)), "")

    def test_the_words_of_vmlight_are_in_all_documents(self):
        words = re.findall(r"(?m)^  (\w+)  +(?:make|vm)\w+ ", output(os.path.join(BIN, "vmlight"), "--help"))
        self.assertEqual(len(words), 7)
        for kind in ("man", "bash", "zsh"):
            document = re.sub(r"\\f[BIR]", " ", text(kind, "vmlight"))  # troff's fonts
            for word in words:
                self.assertRegex(document, rf"(?<![\w-]){word}(?![\w-])", kind)

    def test_bash_completes_flags_words_and_files(self):
        cases = {
            "makelightmap --mod": "--model",
            "makelightmap --model ": "auto ao paper lobe sh mask cells",
            "makelightmap --model = c": "cells",
            "vmexport --for u": "unity unreal",
            "makevismap --channels normal,c": "normal,coverage",
            "makevismap quad.obj --samples ": "",
            "makecfem " + SHARE + "/man/man1/makec": path("man", "makecfem"),
            "vmcost mesh.obj --occluder " + SHARE + "/man/man1/vmc": path("man", "vmcost"),
            "vmlight f": "filter frames",
            "vmlight --v": "--version",
            "vmlight help ex": "export",
            "vmlight light --mod": "--model",
            "vmlight light vm.exr --model = c": "cells",
            "vmlight filter " + SHARE + "/man/man1/makec": path("man", "makecfem"),
            "vmlight nothing --mod": "",
        }
        # vmlight alone finds those of the executables.
        script = "".join(f"source '{path('bash', tool)}'\n" for tool in ["vmlight", *TOOLS])
        for line in cases:
            words = line.split(" ")
            script += f"COMP_WORDS=({' '.join(words[:-1])} '{words[-1]}'); COMP_CWORD={len(words) - 1}\n"
            script += f"_{words[0]}; echo \"${{COMPREPLY[*]}}\"\n"
        self.assertEqual(output("bash", "--norc", "-c", script).splitlines(), list(cases.values()))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
