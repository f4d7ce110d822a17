# SPDX-License-Identifier: Apache-2.0
"""Visibility-map lighting: bake what each texel of a mesh sees, then relight it under any environment.

    vismap = vmlight.make_vismap("hero.obj", resolution=1024, samples=64)
    lightmap = vmlight.make_lightmap(vismap, "studio.hdr", rotate=(0, 90, 0))
    lightmap.write("hero_lit.exr")

Images are numpy arrays over the library's memory: lightmap.pixels, vismap["visibility"].
"""
import functools

from . import _vmlight
from ._vmlight import Error, Image, Mesh, Relighter, Warning, __version__

__all__ = ["Error", "Image", "Mesh", "Relighter", "Warning", "make_cfem", "make_lightmap", "make_reference",
           "make_vismap"]


def _public(native):
    """A function of this module: help() calls that of a compiled one a method of a capsule."""
    @functools.wraps(native, assigned=("__name__", "__doc__"))
    def function(*args, **kwargs):
        return native(*args, **kwargs)

    function.__qualname__ = native.__name__
    return function


make_vismap = _public(_vmlight.make_vismap)
make_cfem = _public(_vmlight.make_cfem)
make_lightmap = _public(_vmlight.make_lightmap)
make_reference = _public(_vmlight.make_reference)
