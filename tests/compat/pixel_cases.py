# SPDX-License-Identifier: Apache-2.0
"""The command lines whose images same_pixels.py compares."""
import dataclasses

SKIES = ["studio_small_03", "kloppenheim_05", "forest_slope", "st_fagans_interior"]
CONFIG = ["--colorconfig", "config.ocio"]
BASES = ["vector", "sh", "mask", "cells"]


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
