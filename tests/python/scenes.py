# SPDX-License-Identifier: Apache-2.0
"""Meshes and skies of the Python tests."""
import os
import shutil
import tempfile
import unittest

import numpy as np

import vmlight

DATA = os.path.join(os.environ["VMLIGHT_SOURCE"], "tests/data")
SPOT = os.path.join(DATA, "spot.obj")
STUDIO = os.path.join(DATA, "studio_small_03.hdr")

# A square with the normal +y, and its UVs from edge to edge.
SQUARE = np.array([(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)], np.float32)
SQUARE_UVS = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32)
SQUARE_TRIANGLES = np.array([(0, 1, 2), (0, 2, 3)])


def plane(scale=1.0):
    return vmlight.Mesh(SQUARE * np.float32(scale), SQUARE_TRIANGLES, SQUARE_UVS, name="plane")


def wall(scale=1e5):
    """A vertical wall at x = 0 that faces +x, without end for what is small."""
    return vmlight.Mesh(np.array([(0, -1, -1), (0, 1, -1), (0, 1, 1), (0, -1, 1)]) * scale, SQUARE_TRIANGLES)


def pit():
    """A floor of side 2 between walls as high: no triangle is open, so that all rays are traced."""
    corners = np.array([(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)], np.float64)
    positions, triangles = [], []
    for i in range(4):
        a, b = corners[i], corners[(i + 1) % 4]
        triangles += [np.array(t) + len(positions) for t in SQUARE_TRIANGLES]
        positions += [a, b, b + (0, 2, 0), a + (0, 2, 0)]
    return vmlight.Mesh(np.array(positions), np.array(triangles))


def latlong_directions(width, height):
    """The direction of each pixel: +z at the centre, y up."""
    phi = 2 * np.pi * ((np.arange(width) + 0.5) / width - 0.5)
    theta = np.pi * (np.arange(height)[:, None] + 0.5) / height
    return np.stack([-np.sin(phi) * np.sin(theta), np.cos(theta) + 0 * phi, np.cos(phi) * np.sin(theta)], -1)


def sky(width=64, height=32):
    """Smooth light that differs by direction."""
    return (1 + 0.5 * latlong_directions(width, height)).astype(np.float32)


class Case(unittest.TestCase):
    def folder(self):
        folder = tempfile.mkdtemp(prefix="vmlight-python-")
        self.addCleanup(shutil.rmtree, folder)
        return folder

    def assert_same(self, first, second):
        np.testing.assert_array_equal(np.asarray(first), np.asarray(second))
