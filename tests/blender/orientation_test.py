# SPDX-License-Identifier: Apache-2.0
"""Rotations of the add-on for Blender, without Blender: its World and ours show the same point of the map.

Run as: orientation_test.py, with VMLIGHT_SOURCE (the repository)."""
import itertools
import math
import unittest

import plain_support  # noqa: F401, which finds the add-on
from vmlight_addon import orientation


class Orientation(unittest.TestCase):
    def assert_same(self, a, b, places=9):
        for x, y in zip(itertools.chain(*a), itertools.chain(*b)):
            self.assertAlmostEqual(x, y, places)

    @staticmethod
    def blender_uv(x, y, z):
        """Where Cycles looks up a direction (kernel/util/projection: direction_to_equirectangular)."""
        return 0.5 - math.atan2(y, x) / (2 * math.pi), 0.5 + math.atan2(z, math.hypot(x, y)) / math.pi

    @staticmethod
    def vmlight_st(x, y, z):
        """The inverse of (-sin phi sin theta, cos theta, cos phi sin theta), phi = 2 pi (s - 1/2), theta = pi t."""
        return 0.5 + math.atan2(-x, z) / (2 * math.pi), math.acos(y) / math.pi

    def assert_same_texel(self, direction, mapping=orientation.IDENTITY, turn=orientation.IDENTITY):
        """A direction of an object's surface, in Blender's axes when it was baked, finds the same point of the map."""
        u, v = self.blender_uv(*orientation.apply(mapping, orientation.apply(turn, direction)))
        x, y, z = direction
        rotation = orientation.from_angles(*orientation.rotate_for_vmlight(mapping, turn))
        s, t = self.vmlight_st(*orientation.apply(rotation, (x, z, -y)))
        self.assertAlmostEqual((u - s + 0.5) % 1, 0.5, 6)
        self.assertAlmostEqual(v, 1 - t, 6)

    DIRECTIONS = [(0.48, 0.6, 0.64), (-0.48, 0.6, -0.64), (0.6, -0.64, 0.48), (-0.6, -0.48, 0.64)]

    def test_an_unturned_world_is_a_quarter_turn_from_ours(self):
        self.assertEqual(orientation.rotate_for_vmlight(), (0, -90, 0))

    def test_a_mapping_of_90_degrees_about_z_is_no_rotation_of_ours(self):
        quarter = orientation.mapping_rotation("POINT", (0, 0, math.radians(90)))
        self.assertEqual(orientation.rotate_for_vmlight(quarter), (0, 0, 0))

    def test_every_mapping_finds_the_texel_that_cycles_finds(self):
        for angles in (0, 0, 0), (0, 0, 35), (35, 0, 0), (0, 35, 0), (20, -35, 110), (0, 90, 0), (15, 90, 40), (15, -90, 0):
            for kind in "POINT", "TEXTURE", "VECTOR", "NORMAL":
                mapping = orientation.mapping_rotation(kind, [math.radians(angle) for angle in angles])
                for direction in self.DIRECTIONS:
                    with self.subTest(angles=angles, kind=kind, direction=direction):
                        self.assert_same_texel(direction, mapping)

    def test_a_turned_object_stays_under_the_same_sky(self):
        turn, mapping = orientation.from_angles(10, 20, 30), orientation.from_angles(40, 50, 60)
        for direction in self.DIRECTIONS:
            self.assert_same_texel(direction, mapping, turn)

    def test_texture_is_the_inverse_of_point(self):
        radians = (0.3, 0.4, 0.5)
        both = orientation.multiply(*(orientation.mapping_rotation(kind, radians) for kind in ("POINT", "TEXTURE")))
        self.assert_same(both, orientation.IDENTITY)

    def test_angles_and_matrices_are_the_same(self):
        for angles in itertools.product((-170, -90, 0, 33, 90), (-90, -60, 0, 45, 90), (-120, 0, 90, 180)):
            rotation = orientation.from_angles(*angles)
            self.assert_same(orientation.from_angles(*orientation.to_angles(rotation)), rotation)
        self.assert_same(orientation.from_angles(0, 0, 90), ((0, -1, 0), (1, 0, 0), (0, 0, 1)))
        half = math.sqrt(0.5)
        self.assert_same(orientation.from_quaternion(half, 0, 0, half), orientation.from_angles(0, 0, 90))

    def test_a_mapping_that_is_no_rotation_is_refused(self):
        self.assertEqual(orientation.mapping_fault("POINT", (0, 0, 0), (2, 2, 2)), "")
        self.assertEqual(orientation.mapping_fault("NORMAL", (1, 0, 0), (1, 1, 1)), "")  # which Blender ignores
        self.assertIn("moves the map by 0, 0, 0.5: set Location to 0",
                      orientation.mapping_fault("TEXTURE", (0, 0, 0.5), (1, 1, 1)))
        for scale in (1, 1, -1), (-1, -1, -1), (1, 2, 1), (0, 0, 0):
            self.assertIn("set Scale to 1", orientation.mapping_fault("POINT", (0, 0, 0), scale))


if __name__ == "__main__":
    unittest.main(verbosity=1)
