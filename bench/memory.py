#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Peak memory of a bake against the size of its output.

    bench/memory.py MESH [RESOLUTION]        (executables in $VMLIGHT_BIN or build/release/bin)

Prints makevismap's peak at that size and at 64x64, where libraries, the mesh and its BVH take all of it.
"""
import os
import resource
import subprocess
import sys
import tempfile

from help_flag import answer_help

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.environ.get("VMLIGHT_BIN", os.path.join(HERE, "../build/release/bin"))


def peak_mb(mesh, resolution):
    """Of one whole process, in a child of its own, because the count is the largest of all children."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([os.path.join(BIN, "makevismap"), mesh, "-o", os.path.join(folder, "vm.exr"), "--quiet",
                            "--resolution", str(resolution), "--samples", "1"], check=True, stderr=subprocess.DEVNULL)
        os.write(writer, str(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss).encode())
        os._exit(0)
    os.close(writer)
    os.waitpid(child, 0)
    return int(os.read(reader, 100) or 0) * 1024 / 1e6


def main():
    answer_help(__doc__)
    if len(sys.argv) < 2:
        sys.exit("usage: bench/memory.py MESH [RESOLUTION]")
    resolution = int(sys.argv[2]) if len(sys.argv) > 2 else 8192
    output = resolution * resolution * 16 / 1e6
    fixed, peak = peak_mb(sys.argv[1], 64), peak_mb(sys.argv[1], resolution)
    print(f"output {output:.0f} MB, peak {peak:.0f} MB; of it {fixed:.0f} MB at 64x64 already (libraries, mesh, BVH)")
    print(f"beyond the output: {100 * (peak / output - 1):.1f} %; beyond output and what 64x64 takes: "
          f"{100 * ((peak - fixed) / output - 1):.1f} %")


if __name__ == "__main__":
    main()
