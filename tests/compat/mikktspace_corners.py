#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Write the tangents that npm's mikktspace (MikkTSpace as WebAssembly) makes for bundled meshes, for the test
Tangents.AreThoseOfMikktspace.

Run as: mikktspace_corners.py
Prints, for every 37th triangle of each mesh: mesh, triangle, corner, tangent and sign. spot.obj, whose file has no normals,
gets those of a sphere about the origin. Needs node with npm, and the internet for one pinned package, which it installs in a
temporary folder."""
import os
import subprocess
import sys
import tempfile

import numpy

import mikktspace_tangents as oracle

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../data")
STEP = 37


def corners_of(path):
    """Positions, normals and UVs of all triangles: [triangles, 3, ...]."""
    tables, faces = oracle.read_obj(path)
    positions = tables["v"]
    if len(tables["vn"]):
        normals = tables["vn"][faces[:, :, 2]]
    else:
        normals = (positions / numpy.linalg.norm(positions, axis=1, keepdims=True))[faces[:, :, 0]]
    return positions[faces[:, :, 0]], normals, tables["vt"][faces[:, :, 1]]


def main():
    with tempfile.TemporaryDirectory() as folder:
        if subprocess.run(["npm", "install", "--no-audit", "--no-fund", "--silent", oracle.PACKAGE], cwd=folder).returncode != 0:
            sys.exit(f"npm cannot install {oracle.PACKAGE}")
        print(f"# npm's {oracle.PACKAGE}, by tests/compat/mikktspace_corners.py: mesh, triangle, corner, tangent, sign")
        for name in "gazebo", "spot":
            tangents = oracle.tangents_of(corners_of(os.path.join(DATA, name + ".obj")), folder)
            for triangle in range(0, len(tangents), STEP):
                for corner, (x, y, z, sign) in enumerate(tangents[triangle]):
                    print(f"{name} {triangle} {corner} {x:.7g} {y:.7g} {z:.7g} {sign:g}")


main()
