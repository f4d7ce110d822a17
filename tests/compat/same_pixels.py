#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Two builds make the same images, bit for bit: every stage, basis, model, mesh format and reader, on the bundled data.

    tests/compat/same_pixels.py OLD_BIN OLD_PLUGINS NEW_BIN NEW_PLUGINS [--quick] [--jobs N] [--keep FOLDER]

Both builds run the same command lines, each in a folder of its own. Then all images are compared: the bits of every pixel,
data formats, channels, tiles, and all metadata except versions. Command lines that one build refuses, the other must refuse
as well, with the same exit code. Prints a table and exits with 1 on any difference.

Build both with the same options, -O2 or -O3: GCC 12's vectoriser changes the last bit of some normals
(trace/surface.cpp), so that a build with -O1 differs from one with -O2 by an ulp here and there in most vismaps.

Needs oiiotool, maketx, and Debian's python3-openimageio and python3-numpy (run it with /usr/bin/python3).
"""
import argparse
import concurrent.futures
import dataclasses
import glob
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib

import numpy
import OpenImageIO as oiio

import mesh_formats

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
SKIES = ["studio_small_03", "kloppenheim_05", "forest_slope", "st_fagans_interior"]
STAGES = ["makevismap", "makecfem", "makelightmap"]
CONFIG = ["--colorconfig", "config.ocio"]
BASES = ["vector", "sh", "mask", "cells"]
VERSIONS = {"vmlight:version", "Software"}
HOSTS_OWN = {"DateTime"}  # what a host adds to an image that it reads through a reader and writes
QUICK_EVERY = 4  # with --quick, one case in so many of those that are not essential


@dataclasses.dataclass
class Case:
    name: str
    words: list  # the tool and its arguments
    outputs: str  # a glob pattern, or "" for a command line that must be refused
    environment: dict = dataclasses.field(default_factory=dict)
    essential: bool = False  # an input of others, or too much on its own to leave out


def case(tool, name, *words, essential=False, outputs=None, environment=None):
    output = outputs or f"{name}.exr"
    return Case(name, [tool, *words, "-o", output.replace("*", "<UDIM>"), "--quiet"], output, environment or {}, essential)


def refused(tool, name, *words):
    return Case(name, [tool, *words, "-o", f"{name}.exr", "--quiet"], "")


def vismap_cases(formats):
    def bake(name, *words, **options):
        if "--resolution" not in words and "--width" not in words:
            words += ("--resolution", "96")
        if "--samples" not in words and "--target-error" not in words:
            words += ("--samples", "24")
        return case("makevismap", "vm_" + name, *words, **options)

    everything = ["--channels", "normal,coverage,error"]
    for basis in BASES:
        yield bake(basis, "spot.obj", "--basis", basis, *everything, "--resolution", "150x130", essential=True)
        uniform = "spot.obj", "--basis", basis, "--measure", "uniform"
        yield bake("uniform", *uniform) if basis == "vector" else refused("makevismap", f"vm_{basis}_uniform", *uniform)
        yield bake(basis + "_occluders", "spot.obj", "--basis", basis, "--occluder", "gazebo.obj", "--occluder", "text.stl")
        yield bake(basis + "_half", "spot.obj", "--basis", basis, "--format", "half", essential=True) if basis in ("vector", "sh") else \
            refused("makevismap", f"vm_{basis}_half", "spot.obj", "--basis", basis, "--format", "half")
    for order in 3, 4, 6, 7, 8:
        yield bake(f"sh{order}", "gazebo.obj", "--basis", "sh", "--order", str(order), essential=True)
    for sampler in "fibonacci", "sobol", "halton":
        yield bake(sampler, "spot.obj", "--sampler", sampler, "--samples", "17")
        yield bake(sampler + "_seed", "spot.obj", "--sampler", sampler, "--seed", "12345", *everything)
        yield bake(sampler + "_target", "gazebo.obj", "--sampler", sampler, "--target-error", "0.05", *everything)
    yield bake("target_fine", "spot.obj", "--target-error", "0.01", "--basis", "cells", "--resolution", "64")
    yield bake("many_rays", "gazebo.obj", "--samples", "1000", "--resolution", "48")
    yield bake("one_ray", "gazebo.obj", "--samples", "1")
    for channels in "normal", "coverage", "error", "error,normal":
        yield bake("channels_" + channels.replace(",", "_"), "gazebo.obj", "--channels", channels)
    for margin in "0", "3", "200", "infinite":
        yield bake("margin_" + margin, "spot.obj", "--margin", margin, "--channels", "normal,coverage")
    for size in ["--resolution", "200x40"], ["--width", "70", "--height", "33"], ["--resolution", "1"]:
        yield bake("size_" + size[-1], "spot.obj", *size)
    for distance in "0.1", "1.5", "infinite":
        yield bake("distance_" + distance, "gazebo.obj", "--max-distance", distance)
    for normals in ["file"], ["smooth"], ["flat"], ["smooth", "--crease-angle", "40"]:
        for mesh in "gazebo", "spot":
            yield bake("_".join(["normals", mesh, *normals]), f"{mesh}.obj", "--normals", *normals, "--channels", "normal")
    for up in "y", "z":
        yield bake("up_" + up, "spot.obj", "--up", up)
        yield bake("up_dae_" + up, "z.dae", "--up", up)
    for mesh in formats:
        yield bake(mesh.replace(".", "_"), mesh, "--channels", "normal", essential=True)
        yield bake("on_" + mesh.replace(".", "_"), "spot.obj", "--occluder", mesh)
    yield bake("on_binary_stl", "spot.obj", "--occluder", "binary.stl")
    yield bake("two_meshes", "two.obj", "--occluder", "mesh.glb", "--occluder", "double.ply")
    yield bake("uv_set", "mesh.gltf", "--uv-set", "1")
    yield bake("far", "far.obj")
    yield bake("one_thread", "spot.obj", "--threads", "1")
    yield bake("tiles", "tiles.obj", "--basis", "sh", outputs="vm_tiles.*.exr", essential=True)
    yield bake("some_tiles", "tiles.obj", "--udims", "1002", outputs="vm_some.*.exr")
    yield bake("one_tile", "tiles.obj", "--udim", "1002")
    yield refused("makevismap", "no_uv", "text.stl")
    yield refused("makevismap", "no_uv_set", "mesh.gltf", "--uv-set", "5")
    yield refused("makevismap", "bad_sampler", "spot.obj", "--sampler", "random")
    yield refused("makevismap", "idle_order", "spot.obj", "--order", "4")
    yield refused("makevismap", "no_mesh", "absent.obj")


def cfem_cases(large):
    def light(name, *words, **options):
        return case("makecfem", "cfem_" + name, *words, **options)

    for sky in SKIES:
        yield light(sky, f"{sky}.hdr", essential=sky == SKIES[0])
        yield light("stack_" + sky, f"{sky}.hdr", "--stack", essential=sky == SKIES[0])
        yield light("sh_" + sky, f"{sky}.hdr", "--filter", "sh")
    for order in 1, 2, 4, 7, 16, 64:
        yield light(f"sh{order}", "kloppenheim_05.hdr", "--filter", "sh", "--order", str(order))
    for size in "64", "33x20", "256", "1":
        yield light("size_" + size, "forest_slope.hdr", "--resolution", size)
        yield light("stack_size_" + size, "forest_slope.hdr", "--resolution", size, "--stack")
    yield light("half", "studio_small_03.hdr", "--format", "half")
    yield light("stack_half", "studio_small_03.hdr", "--format", "half", "--stack")
    yield light("png", "sky.png")
    yield light("png_config", "sky.png", *CONFIG, "--stack")
    yield light("png_raw", "sky.png", "--colorspace", "linear")
    yield light("png16", "sky16.png")
    yield light("half_exr", "half.exr", "--stack")
    yield light("crop", "crop.exr")
    yield light("grey", "grey.exr")
    yield light("tiled", "tiled.exr", "--stack")
    for name, words in {"config": CONFIG, "space": [*CONFIG, "--colorspace", "ACES2065-1", "--sanitize"]}.items():
        yield light(name, "studio_small_03.hdr", *words, essential=True)
        yield light("stack_" + name, "studio_small_03.hdr", "--stack", *words)
    yield light("ocio", "studio_small_03.hdr", environment={"OCIO": "config.ocio"})
    yield light("sanitized", "broken.exr", "--sanitize")
    yield light("sanitized_sh", "broken.exr", "--sanitize", "--filter", "sh")
    yield light("sanitized_stack", "broken.exr", "--sanitize", "--stack")
    yield light("one_thread", "studio_small_03.hdr", "--stack", "--threads", "1")
    yield light("tile", "sky.<UDIM>.png", outputs="cfem_tile.*.exr")
    if large:
        for words in [], ["--stack"], ["--filter", "sh"]:
            yield light("_".join(["large", *words]).replace("-", ""), "large.exr", *words, essential=True)
    yield refused("makecfem", "broken", "broken.exr")
    yield refused("makecfem", "filtered_twice", "vm_vector.exr")
    yield refused("makecfem", "no_space", "studio_small_03.hdr", "--colorspace", "absent", *CONFIG)


def lightmap_cases():
    def light(name, *words, **options):
        return case("makelightmap", "lit_" + name, *words, **options)

    lights = {"cfem": "cfem_studio_small_03.exr", "stack": "cfem_stack_studio_small_03.exr", "sky": "kloppenheim_05.hdr"}
    for basis in BASES:
        models = ["auto", "ao", "paper", "lobe", "sh", "mask", "cells"]
        for model in models:
            for kind, image in lights.items():
                fits = model in ("auto", "ao", "paper") or kind != "cfem" and model in ("lobe", basis)
                words = f"vm_{basis}.exr", image, "--model", model, "--rotate", "20,35,-50"
                if fits:
                    yield light(f"{basis}_{model}_{kind}", *words)
                elif kind != "stack":
                    yield refused("makelightmap", f"lit_{basis}_{model}_{kind}", *words)
        yield light(f"{basis}_light_half", f"vm_{basis}.exr", lights["stack"], "--format", "half")
        yield light(f"{basis}_config", f"vm_{basis}.exr", "forest_slope.hdr", *CONFIG)
    for order in 3, 4, 6, 7, 8:
        for kind in "stack", "sky":
            yield light(f"sh{order}_{kind}", f"vm_sh{order}.exr", lights[kind], "--env-rotate", "0,80,0")
    sh, vector, stack, cfem = "vm_sh.exr", "vm_vector.exr", lights["stack"], lights["cfem"]
    for name, words in {
            "still": [], "rotate": ["--rotate", "10,20,30"], "env_rotate": ["--env-rotate", "-90,45,200"],
            "both": ["--rotate", "5,0,0", "--env-rotate", "0,33,0"], "quaternion": ["--quaternion", "0.8,0,0.6,0"],
            "matrix": ["--matrix", "0.6,0,0.8,0,1,0,-0.8,0,0.6"], "exposure": ["--exposure", "-2.25"],
            "albedo": ["--albedo", "albedo.png"], "albedo_small": ["--albedo", "small.exr"],
            "albedo_raw": ["--albedo", "albedo.png", "--albedo-colorspace", "linear"],
            "albedo_config": ["--albedo", "albedo.png", *CONFIG],
            "threads": ["--threads", "1"]}.items():
        yield light("sh_" + name, sh, stack, *words)
        yield light("vector_" + name, vector, cfem, *words)
    for name, words in {
            "sh": ["--cfem-filter", "sh"], "order": ["--cfem-filter", "sh", "--cfem-order", "6"],
            "size": ["--cfem-resolution", "32x20"]}.items():
        yield light("cfem_" + name, vector, "st_fagans_interior.hdr", "--model", "paper", *words)
    yield light("sanitized", vector, "broken.exr", "--cfem-sanitize")
    yield light("png_sky", sh, "sky.png", *CONFIG, "--albedo", "albedo.png")
    yield light("colorspace", vector, "half.exr", *CONFIG, "--colorspace", "ACES2065-1", "--cfem-sanitize")
    yield light("untagged", vector, "small.exr", "--is-cfem")
    yield light("flags", "hero.lightmap", "--vismap", vector, "--cfem", cfem)
    yield light("half_map", "vm_vector_half.exr", "half.exr", essential=True)
    yield light("frames", sh, stack, "--frames", "1-3", "--rotate-y", "0:90", outputs="lit_frames.####.exr")
    yield light("tiles", "vm_tiles.<UDIM>.exr", "studio_small_03.hdr", outputs="lit_tiles.*.exr", essential=True)
    yield light("some_tiles", "vm_tiles.<UDIM>.exr", stack, "--udims", "1002", outputs="lit_some.*.exr")
    yield light("tile_albedo", "vm_tiles.<UDIM>.exr", stack, "--albedo", "sky.<UDIM>.png", outputs="lit_albedo.*.exr")
    for stage in "vismap", "cfem", "lightmap":
        yield case("make" + stage, "of_recipe_" + stage, f"hero.{stage}", essential=True)
    yield case("makevismap", "of_query_vismap", "hero.vismap?samples=5&basis=mask", "--resolution", "70")
    yield case("makecfem", "of_query_cfem", "hero.cfem?stack=true&resolution=40")
    yield light("query", "hero.lightmap?rotate=0,45,0&exposure=1", essential=True)
    yield light("override", "hero.lightmap", "--model", "paper", "--exposure", "0.5")
    yield light("of_recipes", "hero.vismap?basis=cells", "hero.cfem?stack=true", essential=True)
    yield light("tx", "mip.tx", "hero.cfem", essential=True)
    yield refused("makelightmap", "swapped", cfem, vector)
    yield refused("makelightmap", "no_rotation", vector, cfem, "--matrix", "1,0,0,0,1,0,0,0,2")


def reader_cases():
    images = ["hero.vismap", "hero.cfem", "hero.lightmap", "hero.vismap?channels=normal,error&target_error=0.05",
              "hero.vismap?basis=sh&order=4&margin=infinite", "hero.vismap?basis=cells&resolution=130x70",
              "hero.cfem?stack=true", "hero.cfem?filter=sh&order=5", "hero.lightmap?rotate=0,45,0&exposure=1",
              "hero.lightmap?model=lobe&cfem=hero.cfem?stack=true", "sky.lightmap", "sky.lightmap?albedo=albedo.png",
              "tiles.1002.vismap", "printed.vismap", "printed.cfem", "printed.lightmap"]
    for i, image in enumerate(images):
        plain = image.split("?")[0] + f"_{i}"
        yield Case(plain, ["oiiotool", image, "-o", f"read_{plain}.exr"], f"read_{plain}.exr", essential=i < 3)
        yield Case(plain + "_all", ["oiiotool", "-a", image, "-o", f"all_{plain}.exr"], f"all_{plain}.exr")
        yield Case(plain + "_tiles", ["read_by_tile", image, f"tiles_{plain}.exr"], f"tiles_{plain}.exr", essential=i < 3)
    for level in 1, 4, 9:
        name = f"level_{level}"
        yield Case(name, ["oiiotool", "hero.cfem?stack=true", "--subimage", str(level), "-o", f"{name}.exr"], f"{name}.exr")
    yield Case("cached", ["oiiotool", "--cache", "10", "--autotile", "32", "hero.lightmap", "--cut", "50x40+31+60", "-o",
                          "cached.exr"], "cached.exr")
    yield Case("maketx", ["maketx", "--format", "exr", "hero.vismap", "-o", "made.tx"], "made.tx", essential=True)
    yield Case("absent", ["oiiotool", "absent.vismap", "-o", "absent.exr"], "")
    yield Case("bad_key", ["oiiotool", "hero.vismap?sample=3", "-o", "bad_key.exr"], "")


def printed_recipes():
    return {"printed.vismap": ["makevismap", "spot.obj", "--resolution", "90x80", "--samples", "9", "--occluder", "two.obj",
                               "--basis", "sh", "--order", "3", "--max-distance", "2", "--normals", "flat", "--seed", "3"],
            "printed.cfem": ["makecfem", "sky.png", *CONFIG, "--stack", "--format", "half"],
            "printed.lightmap": ["makelightmap", "printed.vismap", "printed.cfem", "--quaternion", "0.8,0,0.6,0",
                                 "--albedo", "albedo.png", "--exposure", "1"]}


def make_inputs(folder, large):
    """Into `folder`, which becomes the working folder; returns the names of mesh files with texture coordinates."""
    os.chdir(folder)
    data = os.path.join(SOURCE, "tests/data")
    for name in ["spot.obj", "gazebo.obj", *(sky + ".hdr" for sky in SKIES)]:
        shutil.copy(os.path.join(data, name), ".")
    shutil.copy(os.path.join(SOURCE, "configs/ocio/config.ocio"), ".")
    spot, gazebo = mesh_formats.read_obj("spot.obj"), mesh_formats.read_obj("gazebo.obj")
    formats = mesh_formats.write_all(gazebo)

    def moved(corners, x, u):
        return [((p[0] + x, p[1], p[2]), (uv[0] + u, uv[1]), n) for p, uv, n in corners]

    mesh_formats.write_obj("tiles.obj", spot + moved(spot, 1.2, 1))
    mesh_formats.write_obj("two.obj", moved(gazebo, 2, 0))
    mesh_formats.write_obj("far.obj", moved(spot, 40000, 0))
    with open("tiles.1002.vismap", "w") as file:
        file.write('mesh = "tiles.obj"\nresolution = 100\nsamples = 9\n')
    with open("hero.vismap", "w") as file:
        file.write('mesh = "spot.obj"\nresolution = [150, 110]\nsamples = 16\n')
    with open("hero.cfem", "w") as file:
        file.write('environment = "studio_small_03.hdr"\nresolution = 64\n')
    with open("hero.lightmap", "w") as file:
        file.write('vismap = "hero.vismap"\ncfem = "hero.cfem"\nrotate = [0, 30, 0]\n')
    with open("sky.lightmap", "w") as file:
        file.write('vismap = "hero.vismap?basis=sh"\nenvironment = "kloppenheim_05.hdr"\nenv_rotate = [0, 70, 0]\n')
    sky = "studio_small_03.hdr"
    for words in ([sky, "--resize:filter=box", "128x64", "--mulc", "0.5", "-d", "uint8", "-o", "sky.png"],
                  [sky, "--resize:filter=box", "128x64", "--mulc", "0.5", "-d", "uint16", "-o", "sky16.png"],
                  [sky, "--resize:filter=box", "64x32", "-d", "half", "-o", "half.exr"],
                  [sky, "--resize:filter=box", "64x32", "--tile", "32", "32", "-o", "tiled.exr"],
                  [sky, "--resize:filter=box", "80x40", "--cut", "60x20+10+5", "--fullsize", "80x40+0+0", "-o", "crop.exr"],
                  [sky, "--resize:filter=box", "64x32", "--ch", "Y=R", "-o", "grey.exr"],
                  [sky, "--resize:filter=box", "32x16", "-o", "small.exr"],
                  ["--pattern", "checker:width=7:height=7:color1=1,.2,.1:color2=.1,.6,.9", "77x55", "3", "-d", "uint8",
                   "-o", "albedo.png"]):
        subprocess.run(["oiiotool", *words], check=True)
    for udim in "1001", "1002", "1011", "1012":  # those that tiles.obj reaches
        shutil.copy("sky.png", f"sky.{udim}.png")
    image = oiio.ImageInput.open("small.exr")
    pixels = image.read_image(oiio.FLOAT)
    pixels[5, [3, 9, 20], 0] = numpy.nan, numpy.inf, -1
    broken = oiio.ImageOutput.create("broken.exr")
    broken.open("broken.exr", image.spec())
    broken.write_image(pixels)
    broken.close()
    if large:  # more than 256 MiB as floats: read in strips
        words = "kloppenheim_05.hdr --resize:filter=box 6800x3400 -d half -o large.exr".split()
        subprocess.run(["oiiotool", *words], check=True)
    return formats


class Build:
    def __init__(self, bin_folder, plugins, folder, inputs):
        self.bin, self.plugins, self.folder = os.path.abspath(bin_folder), os.path.abspath(plugins), folder
        self.results = {}
        os.mkdir(folder)
        for name in os.listdir(inputs):
            os.link(os.path.join(inputs, name), os.path.join(folder, name))

    def run(self, words, more=None):
        environment = {key: value for key, value in os.environ.items() if key != "OCIO"}
        environment.update(more or {}, OIIO_LIBRARY_PATH=self.plugins)
        if words[0] == "read_by_tile":
            words = ["/usr/bin/python3", os.path.join(HERE, "read_by_tile.py"), *words[1:]]
        elif words[0] in STAGES:
            words = [os.path.join(self.bin, words[0]), *words[1:]]
        return subprocess.run(words, cwd=self.folder, env=environment, capture_output=True, text=True, errors="replace")

    def run_case(self, one):
        self.results[one.name] = self.run(one.words, one.environment)

    def files(self, one):
        pattern = one.outputs.replace("####", "*")
        return sorted(os.path.basename(path) for path in glob.glob(os.path.join(self.folder, pattern)))


def description(spec, ignored):
    kept = {attribute.name: attribute.value for attribute in spec.extra_attribs if attribute.name not in ignored}
    for name in "x", "y", "width", "height", "full_x", "full_y", "full_width", "full_height", "tile_width", "tile_height":
        kept[name] = getattr(spec, name)
    kept["format"], kept["formats"] = str(spec.format), [str(form) for form in spec.channelformats]
    kept["channels"] = spec.channelnames
    return kept


def image_difference(paths, ignored):
    """"" if the files hold the same images, or what differs first."""
    images = [oiio.ImageInput.open(path) for path in paths]
    if None in images:
        return "cannot be read"
    subimage = mip = 0
    while True:
        found = [image.seek_subimage(subimage, mip) for image in images]
        where = f"subimage {subimage}, level {mip}: "
        if found[0] != found[1]:
            return where + "only in one"
        if not found[0] and mip == 0:
            return ""
        if not found[0]:
            subimage, mip = subimage + 1, 0
            continue
        specs = [image.spec() for image in images]
        old, new = (description(spec, ignored) for spec in specs)
        for name in sorted({*old, *new}):
            if repr(old.get(name)) != repr(new.get(name)):  # NaN equals itself
                return f"{where}{name}: {old.get(name)} / {new.get(name)}"
        pixels = [image.read_image(subimage, mip, 0, spec.nchannels, oiio.FLOAT) for image, spec in zip(images, specs)]
        if pixels[0] is None or pixels[1] is None:
            return where + "pixels cannot be read"
        bits = [numpy.ascontiguousarray(array).view(numpy.uint32) for array in pixels]
        differ = bits[0] != bits[1]
        if differ.any():
            with numpy.errstate(all="ignore"):
                most = numpy.nanmax(numpy.abs(pixels[0] - pixels[1]))
            return f"{where}{differ.sum()} of {differ.size} values, by up to {most:.3g}"
        mip += 1


def case_difference(one, builds):
    codes = [build.results[one.name].returncode for build in builds]
    said = builds[1].results[one.name].stderr.strip().split("\n")[-1]
    if codes[0] != codes[1]:
        return f"exit code {codes[0]} / {codes[1]}: {said or builds[0].results[one.name].stderr.strip()}"
    if not one.outputs:
        return "" if codes[0] > 0 else "neither build refuses it"
    if codes[0] != 0:
        return f"both builds fail: {said}"
    old, new = (build.files(one) for build in builds)
    if old != new or not old:
        return f"files: {old} / {new}"
    ours = one.words[0] in STAGES
    for name in old:
        difference = image_difference([os.path.join(build.folder, name) for build in builds],
                                      VERSIONS if ours else VERSIONS | HOSTS_OWN)
        if difference:
            return (name + ", " if len(old) > 1 else "") + difference
    return ""


def print_recipes(builds):
    """Stores the recipes that both print; returns what differs."""
    differences = []
    for name, words in printed_recipes().items():
        texts = [build.run([*words, "--print-recipe"]) for build in builds]
        for build, text in zip(builds, texts):
            with open(os.path.join(build.folder, name), "w") as file:
                file.write(text.stdout)
        try:
            old, new = (tomllib.loads(text.stdout) for text in texts)
        except tomllib.TOMLDecodeError as error:
            differences.append(f"{name}: {error}")
            continue
        if old != new or not old:
            differences.append(f"{name}: {old} / {new}")
    return differences


def main():
    parser = argparse.ArgumentParser(description="Compare the images that two builds make, bit for bit.")
    parser.add_argument("folders", nargs=4, metavar="FOLDER", help="OLD_BIN OLD_PLUGINS NEW_BIN NEW_PLUGINS")
    parser.add_argument("--quick", action="store_true",
                        help=f"one case in {QUICK_EVERY} besides the essential ones, and no large environment")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="processes at a time [%(default)s]")
    parser.add_argument("--keep", metavar="FOLDER", help="keep all images in this folder, which must not exist")
    options = parser.parse_args()
    for folder in options.folders:
        if not os.path.isdir(folder):
            parser.error(f'"{folder}": no such folder')
    options.folders = [os.path.abspath(folder) for folder in options.folders]
    if options.keep:
        options.keep = os.path.abspath(options.keep)
        os.mkdir(options.keep)
    work = options.keep or tempfile.mkdtemp(prefix="vmlight-same-pixels-")
    try:
        return compare(options, work)
    finally:
        os.chdir(HERE)
        if not options.keep:
            shutil.rmtree(work)


def compare(options, work):
    inputs = os.path.join(work, "inputs")
    os.mkdir(inputs)
    formats = make_inputs(inputs, not options.quick)
    old, new = options.folders[:2], options.folders[2:]
    builds = [Build(*old, os.path.join(work, "old"), inputs), Build(*new, os.path.join(work, "new"), inputs)]
    differences = print_recipes(builds)
    for text in differences:
        print("DIFFERS  printed recipe", text)
    count = 0
    table = {}
    readers = list(reader_cases())
    for room, cases in (("vismap", list(vismap_cases(formats))), ("cfem", list(cfem_cases(not options.quick))),
                        ("mips", []), ("lightmap", list(lightmap_cases())), ("readers", readers)):
        if room == "mips":  # what the lightmap of a mipmapped map is made from
            cases = [Case("mip", ["maketx", "--format", "exr", "vm_vector.exr", "-o", "mip.tx"], "mip.tx", essential=True)]
        if options.quick:
            cases = [one for i, one in enumerate(cases) if one.essential or i % QUICK_EVERY == 0]
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            list(pool.map(lambda job: job[0].run_case(job[1]), [(build, one) for one in cases for build in builds]))
        equal = 0
        for one in cases:
            difference = case_difference(one, builds)
            count += 1
            if difference:
                differences.append(difference)
                print(f"DIFFERS  {one.name}: {difference}\n         {' '.join(one.words)}", flush=True)
            equal += not difference
        table[room] = (equal, len(cases), sum(len(builds[0].files(one)) for one in cases if one.outputs),
                       sum(not one.outputs for one in cases))
    print("\nstage      equal / cases   images   refusals")
    for room, (equal, total, images, refusals) in table.items():
        print(f"{room:10} {equal:5} / {total:5} {images:8} {refusals:10}")
    print(f"{len(differences)} of {count} differ" if differences else f"all {count} are the same")
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
