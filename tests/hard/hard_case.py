# SPDX-License-Identifier: Apache-2.0
"""Rows of the table in README.md from tests in Python: as hard_case.h."""
import json
import os


def write_row(test, case, naive, ours, peers=""):
    """Called at the end of `test`, a method of a unittest.TestCase whose class is the row's family."""
    write(test, {"case": case, "naive": naive, "ours": ours, "peers": peers})


def skip_row(test, reason):
    """Skips `test`, which cannot run here: its row stays as it is."""
    write(test, {"skipped": reason})
    test.skipTest(reason)


def write(test, row):
    folder = os.environ.get("VMLIGHT_HARD_ROWS")
    if not folder:
        return
    family, name = type(test).__name__, test._testMethodName[len("test_"):]
    name = "".join(word[:1].upper() + word[1:] for word in name.split("_"))
    with open(os.path.join(folder, f"{family}.{name}.json"), "w") as out:
        json.dump({"family": family, "test": name, **row}, out)
