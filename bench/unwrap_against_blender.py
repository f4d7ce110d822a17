#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The atlas of makevismap --unwrap beside that of Blender's Smart UV Project, both with about the same gap in texels:

  bench/unwrap_against_blender.py MESH... [--resolution 2048] [--margin 4]      (makevismap in $VMLIGHT_BIN or build/release/bin)

Coverage is what triangles cover of the map; stretch is the L2 stretch of the whole atlas (Sander 2001), 1 at best, relative
to the texels that it covers, so that a smaller atlas is not a worse one; overlap is in texels. All three are measured here,
of both, by the same code. Blender is left out where it is not installed."""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile

import numpy

HERE = os.path.dirname(os.path.abspath(__file__))

# Run in Blender: an OBJ in, one with UVs out.
BLENDER = """
import bpy, math, sys, time
source, target, margin = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.wm.obj_import(filepath=source, forward_axis="NEGATIVE_Z", up_axis="Y")
mesh = next(o for o in bpy.context.scene.objects if o.type == "MESH")
bpy.context.view_layer.objects.active = mesh
mesh.select_set(True)
while mesh.data.uv_layers:
    mesh.data.uv_layers.remove(mesh.data.uv_layers[0])
bpy.ops.object.mode_set(mode="EDIT")
bpy.ops.mesh.select_all(action="SELECT")
bpy.ops.mesh.remove_doubles(threshold=0)
start = time.time()
bpy.ops.uv.smart_project(angle_limit=math.radians(66), island_margin=float(margin), margin_method="FRACTION")
print("SECONDS", time.time() - start)
bpy.ops.object.mode_set(mode="OBJECT")
bpy.ops.wm.obj_export(filepath=target, export_selected_objects=True, export_triangulated_mesh=True,
                      export_materials=False)
"""


def read_obj(path):
    """Positions and UVs of the corners of each triangle."""
    places, uvs, corners = [], [], []
    with open(path) as file:
        for line in file:
            words = line.split()
            if words and words[0] == "v":
                places.append([float(word) for word in words[1:4]])
            elif words and words[0] == "vt":
                uvs.append([float(word) for word in words[1:3]])
            elif words and words[0] == "f":
                corners.append([[int(number) - 1 for number in word.split("/")[:2]] for word in words[1:4]])
    corners = numpy.array(corners)
    return numpy.array(places)[corners[:, :, 0]], numpy.array(uvs)[corners[:, :, 1]]


def measure(path, resolution):
    """Coverage in percent, L2 stretch, texels that several triangles cover."""
    places, uvs = read_obj(path)
    p, q = places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]
    area = numpy.linalg.norm(numpy.cross(p, q), axis=1) / 2
    a, b = uvs[:, 1] - uvs[:, 0], uvs[:, 2] - uvs[:, 0]
    doubled = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    good = (area > 0) & (numpy.abs(doubled) > 1e-14)
    p, q, a, b, d, area = p[good], q[good], a[good], b[good], doubled[good, None], area[good]
    du, dv = (p * b[:, 1:] - q * a[:, 1:]) / d, (q * a[:, :1] - p * b[:, :1]) / d
    squares = ((du ** 2).sum(axis=1) + (dv ** 2).sum(axis=1)) / 2
    # A few slivers without width in UV would be all that counts.
    squares = numpy.minimum(squares, numpy.quantile(squares, 0.999))
    covered = numpy.abs(d).sum() / 2
    stretch = numpy.sqrt((squares * area).sum() / area.sum() * covered / area.sum())
    count = numpy.zeros((resolution, resolution), numpy.uint8)
    for triangle in uvs * resolution:
        rasterize(count, triangle)
    return 100 * (count > 0).mean(), stretch, int((count > 1).sum())


def rasterize(count, triangle):
    low = numpy.maximum(numpy.floor(triangle.min(axis=0)), 0).astype(int)
    high = numpy.minimum(numpy.ceil(triangle.max(axis=0)), count.shape[0]).astype(int)
    if (high <= low).any():
        return
    x, y = numpy.meshgrid(numpy.arange(low[0], high[0]) + 0.5, numpy.arange(low[1], high[1]) + 0.5)
    (ax, ay), (bx, by), (cx, cy) = triangle
    sides = [(bx - ax) * (y - ay) - (by - ay) * (x - ax), (cx - bx) * (y - by) - (cy - by) * (x - bx),
             (ax - cx) * (y - cy) - (ay - cy) * (x - cx)]
    # Strictly inside: texel centres on shared edges are of neither, not of both.
    inside = numpy.all([s > 1e-9 for s in sides], axis=0) | numpy.all([s < -1e-9 for s in sides], axis=0)
    count[low[1]:high[1], low[0]:high[0]] += inside


def ours(makevismap, mesh, folder, arguments):
    """The OBJ with our UVs, and seconds."""
    out = os.path.join(folder, "ours.obj")
    said = subprocess.run(
        [makevismap, mesh, "--unwrap", "--write-mesh", out, "-o", os.path.join(folder, "map.exr"), "--samples", "1",
         "--resolution", str(arguments.resolution), "--margin", str(arguments.margin)],
        check=True, capture_output=True, text=True).stdout
    line = next(line for line in said.splitlines() if line.startswith("unwrap: "))
    return out, float(line.split("; ")[-1].split()[0])


def blenders(mesh, folder, arguments):
    script, out = os.path.join(folder, "project.py"), os.path.join(folder, "blender.obj")
    with open(script, "w") as file:
        file.write(BLENDER)
    said = subprocess.run(
        ["blender", "--background", "--factory-startup", "--python", script, "--", mesh, out,
         str(arguments.margin / arguments.resolution)], capture_output=True, text=True).stdout
    times = [line.split()[1] for line in said.splitlines() if line.startswith("SECONDS")]
    if not times or not os.path.exists(out):
        sys.exit("blender failed:\n" + said[-2000:])
    return out, float(times[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--resolution", type=int, default=2048)
    parser.add_argument("--margin", type=int, default=4)
    arguments = parser.parse_args()
    makevismap = os.path.join(os.environ.get("VMLIGHT_BIN", os.path.join(HERE, "../build/release/bin")), "makevismap")
    print(f"{arguments.resolution}x{arguments.resolution} texels, {arguments.margin} apart")
    print(f"{'mesh':32} {'':8} {'coverage':>9} {'stretch':>8} {'overlap':>8} {'seconds':>8}")
    for mesh in arguments.meshes:
        with tempfile.TemporaryDirectory() as folder:
            found = [("vmlight", *ours(makevismap, mesh, folder, arguments))]
            if shutil.which("blender"):
                # The same triangles, as we wrote them: Blender's importers differ.
                found.append(("Blender", *blenders(found[0][1], folder, arguments)))
            for name, path, seconds in found:
                coverage, stretch, overlap = measure(path, arguments.resolution)
                print(f"{os.path.basename(mesh):32} {name:8} {coverage:8.1f}% {stretch:8.3f} {overlap:8} {seconds:8.2f}",
                      flush=True)


main()
