#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The glTF files that vmexport writes, by Khronos' validator (npm's gltf-validator): no error, warning, information or hint.

Run as: gltf_export.py FOLDER_OF_EXECUTABLES
Exit code 77: node or npm is missing, or the package cannot be had. It is installed in a temporary folder."""
import json
import os
import shutil
import subprocess
import sys
import tempfile

PACKAGE = "gltf-validator@2.0.0-dev.3.10"
SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
SKIPPED = 77
BIN = os.path.abspath(sys.argv[1])
NODE = """
const fs = require("fs"), validator = require("gltf-validator");
validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[1]))).then(report => console.log(JSON.stringify(report)));
"""
# Two materials, the second on triangles with and without UVs; and one mesh whose corners have no material at all.
PAINTED = ("mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
           "usemtl red\nf 1/1/1 2/2/1 3/3/1\nusemtl glass\nf 1/1/1 3/3/1 4/4/1\nf 2//1 5//1 6//1\n")
PAINT = "newmtl red\nKd 1 0 0\nnewmtl glass\nKd 1 1 1\nd 0.5\n"


def run(program, *words):
    subprocess.run([os.path.join(BIN, program), *words, "--quiet"], check=True)


def check(name, path):
    result = subprocess.run(["node", "-e", NODE, path], capture_output=True, text=True, check=True)
    report = json.loads(result.stdout)
    issues, info = report["issues"], report["info"]
    print(f"{name}: {info['totalTriangleCount']} triangles, {info['materialCount']} materials, {len(info['resources'])} resources,"
          f" {len(issues['messages'])} issues")
    for message in issues["messages"]:
        print("  ", message["severity"], message["code"], message.get("pointer"), message["message"])
    # The validator must have seen the pictures.
    return not issues["messages"] and sum("image" in resource for resource in info["resources"]) == (2 if "light" in name else 1)


def main():
    if not shutil.which("node") or not shutil.which("npm"):
        print("skipped: node and npm are not both installed")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        if subprocess.run(["npm", "install", "--no-audit", "--no-fund", "--silent", PACKAGE]).returncode != 0:
            print(f"skipped: npm cannot install {PACKAGE}")
            sys.exit(SKIPPED)
        for name, text in (("paint.obj", PAINTED), ("paint.mtl", PAINT)):
            with open(name, "w", encoding="utf-8") as file:
                file.write(text)
        good = True
        sky = os.path.join(SOURCE, "tests/data/studio_small_03.hdr")
        for mesh in os.path.join(SOURCE, "tests/data/spot.obj"), os.path.join(SOURCE, "tests/data/gazebo.obj"), "paint.obj":
            run("makevismap", mesh, "-o", "vm.exr", "--resolution", "64", "--samples", "16")
            run("makelightmap", "vm.exr", sky, "-o", "lit.exr")
            stem = os.path.splitext(os.path.basename(mesh))[0]
            for name, flags in (("occlusion", []), ("light, emissive", ["--lightmap", "lit.exr"]),
                                ("light, unlit", ["--lightmap", "lit.exr", "--gltf-light", "unlit"])):
                run("vmexport", "vm.exr", "--mesh", mesh, "--gltf", "out.glb", *flags)
                good = check(f"{stem}, {name}", "out.glb") and good
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
