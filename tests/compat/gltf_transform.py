#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Real glTF files, as they are and as gltfpack and glTF-Transform compress them, against what glTF-Transform decodes:
both must bake to the same visibility map.

Run as: gltf_transform.py MAKEVISMAP FILE.glb...
Needs node with npm, and the internet for pinned packages, which it installs in a temporary folder. Prints a line a
variant, and ends with 1 if one differs: a float that is rounded otherwise may move an edge by a texel, so that a texel in
a hundred may differ by more than one ray.
"""
import glob
import os
import shutil
import subprocess
import sys
import tempfile

import numpy
import OpenImageIO as oiio

PACKAGES = ("@gltf-transform/core@4.5.1", "@gltf-transform/extensions@4.5.1", "@gltf-transform/functions@4.5.1",
            "draco3dgltf@1.5.7", "meshoptimizer@1.3.0", "gltfpack@1.3.0")
SAMPLES = 64
HERE = os.path.dirname(os.path.abspath(__file__))


def bake(makevismap, mesh):
    """The pixels of a map, or the reason why there is none."""
    path = mesh + ".exr"
    run = subprocess.run([makevismap, mesh, "-o", path, "--resolution", "128", "--samples", str(SAMPLES), "--quiet"],
                         capture_output=True, text=True)
    if run.returncode:
        return run.stderr.split("\n")[0].split('": ')[-1]
    return oiio.ImageBuf(path).get_pixels(oiio.FLOAT)


def compare(makevismap, encoded):
    """Whether a file and its decoded copy bake to the same; prints what was seen."""
    ours, theirs = bake(makevismap, encoded), bake(makevismap, encoded.replace(".glb", "_decoded.glb"))
    name = os.path.basename(encoded)
    if isinstance(ours, str) or isinstance(theirs, str):
        same = isinstance(ours, str) and isinstance(theirs, str) and ours == theirs
        print(f"  {name}: {'both refused' if same else 'DIFFERENT'}: {ours if isinstance(ours, str) else theirs}")
        return same
    apart = numpy.abs(ours - theirs)[..., :4].max(axis=-1)
    covered = max((theirs[..., 0] > 0).sum(), 1)
    many = (apart > 1.5 / SAMPLES).sum() / covered
    same = many < 0.01
    print(f"  {name}: {'same' if same else 'DIFFERENT'}; {100 * many:.2f} % of the texels differ by more than a ray, "
          f"RMS {numpy.sqrt((apart ** 2).sum() / covered):.5f}, mean V {ours[..., 0].sum() / covered:.4f}")
    return same


def main():
    makevismap, files = os.path.abspath(sys.argv[1]), [os.path.abspath(path) for path in sys.argv[2:]]
    good = True
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["npm", "install", "--no-audit", "--no-fund", "--silent", *PACKAGES], cwd=folder, check=True)
        shutil.copy(os.path.join(HERE, "gltf_variants.mjs"), folder)
        for number, path in enumerate(files):
            print(os.path.basename(os.path.dirname(path)) + "/" + os.path.basename(path), flush=True)
            variants = os.path.join(folder, str(number))
            os.mkdir(variants)
            subprocess.run(["node", "gltf_variants.mjs", path, variants], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL)
            for encoded in sorted(glob.glob(os.path.join(variants, "*.glb"))):
                if not encoded.endswith("_decoded.glb"):
                    good &= compare(makevismap, encoded)
    sys.exit(not good)


if __name__ == "__main__":
    main()
