#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What it takes to start:

    bench/startup.py [ROUNDS]        (executables in $VMLIGHT_BIN or build/release/bin)

First, milliseconds of --help and of a wrong flag, each whole process, beside those of /bin/true: by what users start, and by
what works and loads OpenImageIO. Then a small bake, through both: processor time of the whole process, and instructions where
`perf` counts them. All alternating, the least of the rounds.
"""
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

from help_flag import answer_help

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.path.abspath(os.environ.get("VMLIGHT_BIN", os.path.join(HERE, "../build/release/bin")))
WORK = os.path.join(BIN, "../libexec/vmlight")
TOOLS = ["makevismap", "makecfem", "makelightmap", "vmframes", "vmcost", "vmexport", "vmview"]


def run(words):
    """Seconds by the clock, and of the processor."""
    def processor():
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return used.ru_utime + used.ru_stime
    begin, before = time.perf_counter(), processor()
    subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    return time.perf_counter() - begin, processor() - before


def least(commands, rounds):
    """{name: least seconds by the clock, least of the processor}"""
    found = {name: (float("inf"), float("inf")) for name in commands}
    for _ in range(rounds):
        for name, words in commands.items():
            found[name] = tuple(map(min, found[name], run(words)))
    return found


def instructions(words):
    """Of the whole process, in user space; None where they cannot be counted."""
    if not shutil.which("perf"):
        return None
    text = subprocess.run(["perf", "stat", "-x,", "-e", "instructions:u", *words], capture_output=True, text=True,
                          check=False).stderr
    count = re.search(r"^(\d+),", text, re.MULTILINE)
    return int(count[1]) if count else None


def main():
    answer_help(__doc__)
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 10
    tools = [tool for tool in TOOLS if os.path.exists(os.path.join(BIN, tool))]
    commands = {"true": ["/bin/true"], "vmlight --help": [os.path.join(BIN, "vmlight"), "--help"]}
    for tool in tools:
        commands[f"{tool} --help"] = [os.path.join(BIN, tool), "--help"]
        commands[f"{tool} --nonsense"] = [os.path.join(BIN, tool), "--nonsense"]
        commands[f"{tool}.bin --help"] = [os.path.join(WORK, tool + ".bin"), "--help"]
    found = least(commands, rounds)
    print(f"{'command':<26}{'ms':>8}{'/ true':>9}{'processor ms':>14}")
    for name, (wall, processor) in found.items():
        print(f"{name:<26}{1e3 * wall:8.1f}{wall / found['true'][0]:9.1f}{1e3 * processor:14.1f}")
    with tempfile.TemporaryDirectory() as folder:
        job = [os.path.join(HERE, "../tests/data/spot.obj"), "-o", os.path.join(folder, "vm.exr"), "--resolution", "64",
               "--samples", "16", "--threads", "1", "--quiet"]
        both = {"through": [os.path.join(BIN, "makevismap"), *job], "direct": [os.path.join(WORK, "makevismap.bin"), *job]}
        found = least(both, 3 * rounds)
        counts = {name: instructions(words) for name, words in both.items()}
    print(f"a small bake: processor time through the front / direct: {found['through'][1] / found['direct'][1]:.4f} "
          f"({1e3 * found['direct'][1]:.0f} ms)")
    if all(counts.values()):
        print(f"a small bake: instructions through the front / direct: {counts['through'] / counts['direct']:.4f}")


if __name__ == "__main__":
    main()
