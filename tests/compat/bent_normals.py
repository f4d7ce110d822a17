#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Bent normals that vmexport writes in tangent space, decoded in tangents that npm's mikktspace (MikkTSpace as WebAssembly) makes
for the same mesh, against B/|B| of the map.

Run as: bent_normals.py FOLDER_OF_EXECUTABLES MESH...
The error bounds are those of mikktspace_tangents.py, whose tangents these are, and a step of the texture. Exit code 77: node or npm
is missing, or the package cannot be had. It is installed in a temporary folder."""
import os
import shutil
import subprocess
import sys
import tempfile

import numpy
import OpenImageIO as oiio

import mikktspace_tangents as oracle

SKIPPED = 77
BIN = os.path.abspath(sys.argv[1])
SIDE = oracle.SIDE


def run(program, *words):
    subprocess.run([os.path.join(BIN, program), *words, "--quiet"], check=True)


def pixels_of(path):
    image = oiio.ImageBuf(path)
    return list(image.spec().channelnames), image.get_pixels(oiio.FLOAT).astype(float)


def decode(corners, tangents, local):
    """[SIDE, SIDE, 3]: x T + y B + z N of each texel, normalised; not a number where no triangle is, or several are."""
    axes = [oracle.mapped_directions(corners, tangents, axis) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
    mapped = sum(axis * local[..., k:k + 1] for k, axis in enumerate(axes))
    return mapped / numpy.linalg.norm(mapped, axis=-1, keepdims=True)


def check(mesh):
    run("makevismap", mesh, "--write-mesh", "written.obj", "-o", "vm.exr", "--resolution", str(SIDE), "--samples", "16", "--channels",
        "coverage")
    corners = oracle.corners_of("written.obj")
    tangents = oracle.tangents_of(corners, ".")
    names, map_pixels = pixels_of("vm.exr")
    b = map_pixels[..., [names.index("direction." + axis) for axis in "xyz"]]
    length = numpy.linalg.norm(b, axis=-1)
    open_texels = (length > 0) & (map_pixels[..., names.index("coverage")] == 1)
    good = True
    for engine, sign in (("godot", 1), ("unreal", -1)):
        for depth in (8, 16):
            run("vmexport", "vm.exr", "--for", engine, "--mesh", mesh, "--depth", str(depth), "--maps", "bent_normal", "-o", engine)
            local = 2 * pixels_of(f"{engine}/vm_bent_normal.png")[1] - 1
            local[..., 1] *= sign
            seen = decode(corners, tangents, local)
            both = open_texels & numpy.isfinite(seen[..., 0])
            apart = numpy.linalg.norm(seen[both] - b[both] / length[both][:, None], axis=-1)
            step = numpy.sqrt(3) / (2 ** depth - 1)
            rms = numpy.sqrt((apart ** 2).mean())
            good = good and both.sum() > 10000 and rms < oracle.BOUND + step and apart.max() < oracle.FARTHEST + 1.5 * step
            print(f"{os.path.basename(mesh)} {engine} {depth} bit: {int(both.sum())} texels, apart by {rms:.2g} (RMS), at most"
                  f" {apart.max():.2g}; a step is {step:.2g}")
    return good


def main():
    if not shutil.which("node") or not shutil.which("npm"):
        print("skipped: node and npm are not both installed")
        sys.exit(SKIPPED)
    meshes = [os.path.abspath(mesh) for mesh in sys.argv[2:]]
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        if subprocess.run(["npm", "install", "--no-audit", "--no-fund", "--silent", oracle.PACKAGE]).returncode != 0:
            print(f"skipped: npm cannot install {oracle.PACKAGE}")
            sys.exit(SKIPPED)
        results = [check(mesh) for mesh in meshes]
    sys.exit(0 if results and all(results) else 1)


if __name__ == "__main__":
    main()
