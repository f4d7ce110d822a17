# SPDX-License-Identifier: Apache-2.0
"""Reads an image tile by tile, last tile first, as a renderer would, and stores it as an EXR, for same_pixels.py:

    read_by_tile.py IMAGE OUTPUT.exr
"""
import sys

import numpy
import OpenImageIO as oiio


def main(name, output):
    image = oiio.ImageInput.open(name)
    if not image:
        sys.exit(oiio.geterror())
    specs, pixels = [], []
    subimage = 0
    while image.seek_subimage(subimage, 0):
        spec = image.spec()
        if not spec.tile_width:
            sys.exit(f"{name}: no tiles")
        array = numpy.zeros((spec.height, spec.width, spec.nchannels), numpy.float32)
        for y in reversed(range(0, spec.height, spec.tile_height)):
            for x in reversed(range(0, spec.width, spec.tile_width)):
                x_end, y_end = min(x + spec.tile_width, spec.width), min(y + spec.tile_height, spec.height)
                tile = image.read_tiles(subimage, 0, x, x_end, y, y_end, 0, 1, 0, spec.nchannels, oiio.FLOAT)
                if tile is None:
                    sys.exit(image.geterror())
                array[y:y_end, x:x_end] = numpy.reshape(tile, (y_end - y, x_end - x, spec.nchannels))
        specs.append(spec)
        pixels.append(array)
        subimage += 1
    out = oiio.ImageOutput.create(output)
    if not out.open(output, tuple(specs)):
        sys.exit(out.geterror())
    for subimage, (spec, array) in enumerate(zip(specs, pixels)):
        if subimage and not out.open(output, spec, "AppendSubimage"):
            sys.exit(out.geterror())
        if not out.write_image(array):
            sys.exit(out.geterror())
    out.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
