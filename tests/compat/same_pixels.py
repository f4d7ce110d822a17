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
from pixel_cases import CONFIG, SKIES, Case, cfem_cases, lightmap_cases, reader_cases, vismap_cases

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
STAGES = ["makevismap", "makecfem", "makelightmap"]
VERSIONS = {"vmlight:version", "Software"}
HOSTS_OWN = {"DateTime"}  # what a host adds to an image that it reads through a reader and writes
QUICK_EVERY = 4  # with --quick, one case in so many of those that are not essential


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
