#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Peak memory and time to the first ray of a mesh of many triangles.

    bench/large_mesh.py [MILLIONS] [OTHER_BIN]      (executables in $VMLIGHT_BIN or build/release/bin)

Writes a PLY of a wavy grid of so many million triangles (5), each vertex with a normal and texture coordinates, and the same as a height
image, and bakes each at 64x64 with one ray per texel: the least time of three runs, and the peak in bytes a triangle beyond that of
a small mesh. With OTHER_BIN, the folder of another build's executables, its figures for the PLY too, alternating.
"""
import array
import math
import os
import struct
import subprocess
import sys
import tempfile
import time
import zlib

from help_flag import answer_help

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.environ.get("VMLIGHT_BIN", os.path.join(HERE, "../build/release/bin"))


def height(x, z):
    return 0.5 + 0.2 * math.sin(7 * x) * math.cos(5 * z) + 0.02 * math.sin(60 * x) * math.sin(50 * z)


def write_ply(path, side):
    with open(path, "wb") as file:
        file.write(("ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % (side * side) + "".join(
            f"property float {name}\n" for name in "x y z nx ny nz u v".split())
            + "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % (2 * (side - 1) ** 2)).encode())
        for j in range(side):
            row = array.array("f")
            for i in range(side):
                u, v = i / (side - 1), j / (side - 1)
                row.extend((2 * u - 1, height(u, v), 2 * v - 1, 0, 1, 0, 0.01 + 0.98 * u, 0.99 - 0.98 * v))
            row.tofile(file)
        pack = struct.Struct("<B3iB3i").pack
        for j in range(side - 1):
            file.write(b"".join(pack(3, a, a + side, a + side + 1, 3, a, a + side + 1, a + 1)
                                for a in range(j * side, j * side + side - 1)))


def write_png(path, side):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + struct.pack(f">{side}H", *(round(65535 * height(i / (side - 1), j / (side - 1)))
                                                       for i in range(side))) for j in range(side))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 16, 0, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(rows, 1)) + chunk(b"IEND", b""))


def run(folder, arguments, executables):
    """Seconds, and peak bytes."""
    start = time.monotonic()
    process = subprocess.Popen([os.path.join(executables, "makevismap"), *arguments, "--resolution", "64", "--samples", "1",
                                "--quiet", "-o", os.path.join(folder, "vm.exr")])
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        sys.exit("makevismap failed")
    return time.monotonic() - start, usage.ru_maxrss * 1024


def main():
    answer_help(__doc__)
    millions = float(sys.argv[1]) if len(sys.argv) > 1 else 5
    side = round(math.sqrt(millions * 5e5)) + 1
    triangles = 2 * (side - 1) ** 2
    with tempfile.TemporaryDirectory() as folder:
        ply, small, png = (os.path.join(folder, name) for name in ("large.ply", "small.ply", "large.png"))
        write_ply(ply, side)
        write_ply(small, 3)
        write_png(png, side)
        cases = [("PLY", [ply], BIN), ("height image", [png, "--terrain", "1m/px"], BIN)]
        if len(sys.argv) > 2:
            cases.append(("PLY, other build", [ply], sys.argv[2]))
        found = {}
        for _ in range(3):
            for name, arguments, executables in cases:
                base = run(folder, [small], executables)[1]
                seconds, peak = run(folder, arguments, executables)
                found.setdefault(name, []).append((seconds, (peak - base) / triangles))
        for name, runs in found.items():
            print(f"{name:16s} {triangles / 1e6:.1f} M triangles: first ray and all else within {min(runs)[0]:.1f} s, "
                  f"peak {min(each for _, each in runs):.0f} B a triangle")


if __name__ == "__main__":
    main()
