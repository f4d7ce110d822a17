# SPDX-License-Identifier: Apache-2.0
"""Relights the baked objects of a scene: in this process by OpenImageIO and vmlight's reader, else by makelightmap."""
import hashlib
import os

import bpy

from . import lit_image, orientation, preferences, recipe, render_pixels, status, tools, world

is_rendering = False  # then what is relit must be what the frame shows: see handlers.py


def baked_objects(scene):
    return [ob for ob in scene.objects if ob.vmlight.vismap]


def session_folder():
    """For what can be made again: removed when Blender quits."""
    return os.path.join(bpy.app.tempdir, "vmlight")


def maps_folder(scene):
    """Where the visibility maps go; a path that starts at an unsaved .blend leads nowhere."""
    folder = scene.vmlight.folder
    if not folder or (folder.startswith("//") and not bpy.data.filepath):
        return session_folder()
    return os.path.normpath(bpy.path.abspath(folder))


def environment(scene, depsgraph=None):
    """@param depsgraph: whose World is read: an animated one differs from the original in renders
    @raises world.Unfollowable"""
    settings = scene.vmlight
    if not settings.follow_world:
        return world.of_file(settings.environment, settings.rotation)
    shown = scene.world
    if depsgraph and shown:
        shown = shown.evaluated_get(depsgraph)
    return world.of_world(shown, session_folder())


def light_of_scene(scene, sky, turn=orientation.IDENTITY):
    """What lights the scene: rotate (degrees), exposure (stops), model, colorspace, repair.

    @param turn: of an object since it was baked"""
    settings = scene.vmlight
    return {"rotate": orientation.rotate_for_vmlight(sky.mapping, turn), "exposure": settings.exposure + sky.stops,
            "model": settings.model, "colorspace": sky.colorspace, "repair": settings.repair}


def light_of(ob, scene, sky, depsgraph=None):
    turned = ob.evaluated_get(depsgraph) if depsgraph else ob
    now = orientation.from_quaternion(*turned.matrix_world.to_quaternion())
    then = orientation.from_quaternion(*ob.vmlight.turn)
    turn = orientation.multiply(now, orientation.transposed(then))
    if max(abs(turn[i][j] - (i == j)) for i in range(3) for j in range(3)) < 1e-6:
        turn = orientation.IDENTITY  # a matrix of floats
    return light_of_scene(scene, sky, turn)


def refresh(scene, depsgraph=None, force=False):
    """Relights each baked object whose light changed. What goes wrong is shown in the panel.

    @returns how many objects were relit"""
    objects = baked_objects(scene)
    if not objects:
        return 0
    faults, relit = [], 0
    try:
        sky = environment(scene, depsgraph)
    except world.Unfollowable as fault:
        sky, objects = None, []
        faults.append(str(fault))
    for ob in objects:
        light = light_of(ob, scene, sky, depsgraph)
        vismap = bpy.path.abspath(ob.vmlight.vismap, library=ob.library)
        key = _key(vismap, sky.path, light)
        if not force and key == ob.vmlight.lit_as and ob.vmlight.image:
            continue
        try:
            lit_image.show(ob, _lit(vismap, sky.path, light))
            ob.vmlight.lit_as = key
            relit += 1
        except (render_pixels.Failed, tools.Missing) as fault:
            faults.append(f'"{ob.name}": {fault}')
    if relit or faults != status.light_faults:
        status.light_faults = faults
        status.redraw()
    return relit


def _lit(vismap, sky, light):
    """Rows of pixels from the top: R, G, B."""
    if not os.path.isfile(vismap):
        raise render_pixels.Failed(f'"{vismap}": no such file: bake again')
    folder = session_folder()
    os.makedirs(folder, exist_ok=True)
    text = recipe.text(vismap, sky, light, folder)
    path = os.path.join(folder, hashlib.sha256(text.encode()).hexdigest()[:16] + ".lightmap")
    if not os.path.isfile(path):
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    return render_pixels.pixels(vismap, sky, path, light, folder, preferences.find)


def _key(vismap, sky, light):
    def stamp(path):
        try:
            return f"{path}@{os.stat(path).st_mtime_ns}"
        except OSError:
            return path
    return "|".join((stamp(vismap), stamp(sky), tools.numbers(light["rotate"]), f"{light['exposure']:.9g}", light["model"],
                     light["colorspace"], str(int(light["repair"]))))


def command(ob, scene):
    """The makelightmap line of what an object shows. @raises world.Unfollowable"""
    sky = environment(scene)
    light = light_of(ob, scene, sky)
    words = ["makelightmap", bpy.path.abspath(ob.vmlight.vismap), sky.path, "-o", tools.file_name(ob.name) + "_lit.exr",
             "--rotate", tools.numbers(light["rotate"]), "--exposure", f"{light['exposure']:.9g}", "--model", light["model"]]
    return words + tools.environment_flags(light)


def schedule(depsgraph=None):
    """Relights soon, once for all changes until then. Without a window nothing would run later: at once."""
    if bpy.app.background:
        refresh(bpy.context.scene, depsgraph)
    elif not bpy.app.timers.is_registered(_refresh_soon):
        bpy.app.timers.register(_refresh_soon, first_interval=0.01)


def _refresh_soon():
    scene = bpy.context.scene
    if scene and not is_rendering:
        refresh(scene)
