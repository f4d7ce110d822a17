# SPDX-License-Identifier: Apache-2.0
"""8-bit PNGs without a library, so that scripts that make scenes run on a bare Python."""
import struct
import zlib

COLOR_TYPES = {3: 2, 4: 6}  # channels: PNG's number for RGB and RGBA


def encode(rows):
    """The file's bytes, for rows of pixels, each a tuple of 3 or 4 numbers from 0 to 255."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    data = b"".join(b"\0" + b"".join(map(bytes, row)) for row in rows)
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, COLOR_TYPES[len(rows[0][0])], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b"")
