# SPDX-License-Identifier: Apache-2.0
"""Read images by OpenImageIO's Python module and print size, channels and the mean of each channel, a line an image."""
import sys

import OpenImageIO

for path in sys.argv[1:]:
    image = OpenImageIO.ImageInput.open(path)
    if image is None:
        sys.exit(OpenImageIO.geterror())
    spec = image.spec()
    pixels = image.read_image(OpenImageIO.FLOAT)
    count = spec.width * spec.height
    means = [sum(float(p[c]) for row in pixels for p in row) / count for c in range(spec.nchannels)]
    print(spec.width, spec.height, ",".join(spec.channelnames), *("%.9g" % m for m in means))
    image.close()
