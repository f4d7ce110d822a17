#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A forest on a terrain: time and peak memory of bakes against many instances.

    bench/forest.py [INSTANCES] [TREE_TRIANGLES] [RESOLUTION]       (executables in $VMLIGHT_BIN or build/release/bin)

Makes a terrain of 1025 x 1025 heights, a tree, and a glTF of INSTANCES trees by EXT_mesh_gpu_instancing (a million of 10,000
triangles each), and bakes the terrain under none, 1 %, 10 % and all of them, with 16 rays per texel at RESOLUTION (256). Prints
wall time, peak memory, and what an instance takes beyond the bare terrain.
"""
import array
import json
import math
import os
import random
import struct
import subprocess
import sys
import tempfile
import time
import zlib

from help_flag import answer_help

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.environ.get("VMLIGHT_BIN", os.path.join(HERE, "../build/release/bin"))
SIDE, SPACING, HIGHEST = 1025, 4.0, 400.0


def height(x, z):
    """Of the ground, 0 to 1, at -1 to 1."""
    return 0.5 + 0.2 * math.sin(3 * x + 1) * math.cos(2 * z) + 0.1 * math.sin(11 * x * z + 5 * z) + 0.05 * math.sin(23 * x)


def write_terrain(path):
    """A 16-bit grey PNG."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + struct.pack(f">{SIDE}H", *(round(65535 * height(2 * i / (SIDE - 1) - 1, 2 * j / (SIDE - 1) - 1))
                                                       for i in range(SIDE))) for j in range(SIDE))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", SIDE, SIDE, 16, 0, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(rows, 1)) + chunk(b"IEND", b""))


def tree(triangles):
    """A cone of leaves, each a triangle, on a trunk of three sides; 1 high."""
    rng = random.Random(1)
    corners = array.array("f")
    for k in range(3):
        a, b = 2 * math.pi * k / 3, 2 * math.pi * (k + 1) / 3
        for angle, y in ((a, -0.05), (b, -0.05), (0, 1)):
            corners.extend((0.03 * math.cos(angle), y, 0.03 * math.sin(angle)))
    for _ in range(triangles - 3):
        y = 0.2 + 0.8 * rng.random()
        r, angle = 0.3 * (1.05 - y) * math.sqrt(rng.random()), 2 * math.pi * rng.random()
        for _ in range(3):
            corners.extend((r * math.cos(angle) + rng.uniform(-.01, .01), y + rng.uniform(-.01, .01),
                            r * math.sin(angle) + rng.uniform(-.01, .01)))
    return corners


def write_forest(path, count, triangles):
    rng = random.Random(2)
    corners, places, turns, sizes = tree(triangles), array.array("f"), array.array("f"), array.array("f")
    half = SPACING * (SIDE - 1) / 2
    for _ in range(count):
        x, z, angle, size = rng.uniform(-1, 1), rng.uniform(-1, 1), math.pi * rng.random(), rng.uniform(4, 12)
        places.extend((half * x, HIGHEST * height(x, z), half * z))
        turns.extend((0, math.sin(angle), 0, math.cos(angle)))
        sizes.extend((size, size * rng.uniform(0.8, 1.5), size))
    views, accessors, body = [], [], b""
    for numbers, kind in ((corners, "VEC3"), (places, "VEC3"), (turns, "VEC4"), (sizes, "VEC3")):
        data = numbers.tobytes()
        views.append({"buffer": 0, "byteOffset": len(body), "byteLength": len(data)})
        accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "type": kind,
                          "count": len(numbers) // int(kind[3])})
        body += data
    accessors[0].update(min=[-1, -1, -1], max=[1, 2, 1])
    scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "accessors": accessors,
             "bufferViews": views, "buffers": [{"byteLength": len(body)}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
             "nodes": [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {
                 "attributes": {"TRANSLATION": 1, "ROTATION": 2, "SCALE": 3}}}}],
             "extensionsUsed": ["EXT_mesh_gpu_instancing"]}
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(body), len(text), b"JSON") + text
                   + struct.pack("<I4s", len(body), b"BIN\0") + body)


def run(*arguments):
    """Seconds, peak MB and what it says."""
    start = time.monotonic()
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen([os.path.join(BIN, "makevismap"), *map(str, arguments)], stdout=said, stderr=said)
        _, status, usage = os.wait4(process.pid, 0)
        said.seek(0)
        text = said.read().decode()
    if status:
        sys.exit(text)
    return time.monotonic() - start, usage.ru_maxrss * 1024 / 1e6, text


def main():
    answer_help(__doc__)
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000000
    triangles = int(sys.argv[2]) if len(sys.argv) > 2 else 10000
    resolution = sys.argv[3] if len(sys.argv) > 3 else "256"
    with tempfile.TemporaryDirectory() as folder:
        terrain = os.path.join(folder, "terrain.png")
        write_terrain(terrain)
        bake = [terrain, "--terrain", f"{SPACING}m/px", "--height-scale", HIGHEST, "--resolution", resolution, "--samples", 16]
        bare = None
        for trees in (0, count // 100, count // 10, count):
            forest = os.path.join(folder, "forest.glb")
            if trees:
                write_forest(forest, trees, triangles)
            arguments = bake + (["--occluder", forest] if trees else [])
            seconds, peak, text = run(*arguments, "-o", os.path.join(folder, "vm.exr"))
            bare = bare or peak
            expected = [line for line in run(*arguments, "--dry-run")[2].splitlines() if "MB of memory" in line]
            each = f", {1e6 * (peak - bare) / trees:.0f} B an instance" if trees else ""
            print(f"{trees:8d} trees, {trees * triangles:.3g} triangles: {seconds:6.1f} s, peak {peak:6.0f} MB{each}")
            print("         " + "; ".join(expected), flush=True)


main()
