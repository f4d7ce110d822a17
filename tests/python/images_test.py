# SPDX-License-Identifier: Apache-2.0
"""Images and numpy: what is shared, what is copied, what is refused.

Run as: images_test.py, with VMLIGHT_SOURCE and the package on PYTHONPATH"""
import gc
import os
import unittest

import numpy as np

import vmlight
from scenes import STUDIO, Case, plane, sky

try:
    import OpenImageIO
except ImportError:
    OpenImageIO = None


def address(array):
    return np.asarray(array).__array_interface__["data"][0]


class Arrays(Case):
    def test_results_are_seen_without_a_copy(self):
        image = vmlight.make_cfem(sky(), resolution=(8, 4))
        self.assertEqual(image.pixels.shape, (4, 8, 3))
        self.assertEqual(image.pixels.dtype, np.float32)
        for view in np.asarray(image), image["R"], np.frombuffer(image, np.float32), memoryview(image):
            self.assertEqual(address(view), address(image.pixels))
        image.pixels[0, 0] = 7
        self.assert_same(image["G"][0, 0], np.float32(7))

    def test_pixels_outlive_their_image(self):
        pixels = vmlight.make_cfem(sky()).pixels
        expected = pixels.copy()
        gc.collect()
        for _ in range(4):
            vmlight.make_cfem(sky() * 2)
        self.assert_same(pixels, expected)

    def test_arrays_outlive_their_owner(self):
        array = sky()
        expected = array.copy()
        image = vmlight.Image(array)
        self.assertEqual(address(image), address(array))
        pixels = image.pixels
        del array, image
        gc.collect()
        self.assert_same(pixels, expected)

    def test_a_relighter_keeps_what_it_was_given(self):
        light = sky()
        vismap = vmlight.make_vismap(plane(), resolution=8)
        relighter = vmlight.Relighter(vismap, light)
        first = relighter.light().pixels.copy()
        del light, vismap
        gc.collect()
        self.assert_same(relighter.light(), first)

    def test_results_that_are_held_are_never_written_again(self):
        relighter = vmlight.Relighter(vmlight.make_vismap(plane(), resolution=8), sky())
        turns = [(10 * i, 0, 20 * i) for i in range(6)]
        held = [relighter.light(rotate=turn) for turn in turns]
        views = [relighter.light(rotate=turn).pixels for turn in turns]
        for turn, image, view in zip(turns, held, views):
            again = relighter.light(rotate=turn)
            self.assert_same(image, again)
            self.assert_same(view, again)

    def test_results_that_nobody_holds_give_their_memory_back(self):
        relighter = vmlight.Relighter(vmlight.make_vismap(plane(), resolution=8), sky())
        places = set()
        for i in range(20):
            lit = relighter.light(exposure=i)
            places.add(address(lit))
        self.assertEqual(len(places), 2)

    def test_other_arrays_of_floats_give_the_same(self):
        light = sky()
        expected = vmlight.make_cfem(light)
        for other in (light.astype(np.float64), light.astype(">f4"), np.asfortranarray(light),
                      light[::-1][::-1], np.repeat(light, 2, axis=1)[:, ::2], light[:, ::-1][:, ::-1]):
            self.assert_same(vmlight.make_cfem(other), expected)
        half = light.astype(np.float16)
        self.assert_same(vmlight.make_cfem(half), vmlight.make_cfem(half.astype(np.float32)))
        flipped = light[::-1]
        self.assert_same(vmlight.make_cfem(flipped), vmlight.make_cfem(flipped.copy()))
        unaligned = np.frombuffer(b"x" + light.tobytes(), np.uint8)[1:].view(np.float32).reshape(light.shape)
        self.assert_same(vmlight.make_cfem(unaligned), expected)

    def test_what_is_read_only_stays_so(self):
        light = sky()
        light.flags.writeable = False
        image = vmlight.Image(light)
        self.assertFalse(image.pixels.flags.writeable)
        with self.assertRaises(ValueError):
            image.pixels[0] = 0
        self.assert_same(vmlight.make_cfem(image), vmlight.make_cfem(sky()))

    def test_other_arrays_are_refused(self):
        for array, error, text in [
            (np.ones((4, 8, 3), np.uint8), TypeError, "must be floats, not uint8"),
            (np.ones((4, 8, 3), int), TypeError, "must be floats, not int64"),
            (np.ones((4, 8, 3), bool), TypeError, "must be floats, not bool"),
            (np.ones((4, 8, 3), complex), TypeError, "must be floats, not complex128"),
            (np.ones(8, np.float32), ValueError, r"\(height, width, channels\), not \(8,\)"),
            (np.ones((1, 4, 8, 3), np.float32), ValueError, "must have the shape"),
            (np.ones((0, 8, 3), np.float32), ValueError, "8 x 0 pixels"),
            (np.ones((4, 0, 3), np.float32), ValueError, "0 x 4 pixels"),
            (np.ones((4, 8, 0), np.float32), ValueError, "of 0 channels"),
            (np.ones((4, 8, 7), np.float32), ValueError, "has 7 channels: name them"),
            ("nonsense", TypeError, "pixels: must be an image"),
            ([[1.0]], TypeError, "pixels: must be an image"),
            (None, TypeError, "pixels: must be an image"),
        ]:
            with self.subTest(text=text), self.assertRaisesRegex(error, text):
                vmlight.Image(array)
        with self.assertRaisesRegex(ValueError, "2 names for 3 channels"):
            vmlight.Image(sky(), channels=["R", "G"])
        with self.assertRaisesRegex(TypeError, "environment: must be an image"):
            vmlight.make_cfem([[1.0]])

    def test_huge_arrays_are_refused_before_they_are_copied(self):
        # Of one pixel in memory: a copy would need 4 TB.
        huge = np.broadcast_to(np.float64(1), (1 << 20, 1 << 20, 1))
        with self.assertRaisesRegex(vmlight.Error, "environment: .*GB of memory"):
            vmlight.make_cfem(huge)
        with self.assertRaisesRegex(ValueError, "must be from 1 x 1 x 1 to 1048576"):
            vmlight.make_cfem(np.broadcast_to(np.float32(1), (1, (1 << 20) + 1, 1)))
        with self.assertRaisesRegex(vmlight.Error, "GB of memory"):
            vmlight.make_vismap(plane(), resolution=32768, basis="sh", order=8)

    def test_bad_pixels_are_refused_and_repaired_on_request(self):
        for value in np.nan, np.inf, -1:
            light = sky()
            light[3, 5] = value
            with self.assertRaisesRegex(vmlight.Error, "sanitize"):
                vmlight.make_cfem(light)
            self.assertTrue(np.isfinite(vmlight.make_cfem(light, sanitize=True).pixels).all())

    def test_a_map_of_four_channels_needs_no_names(self):
        vismap = vmlight.make_vismap(plane(), resolution=8)
        self.assert_same(vmlight.make_lightmap(vismap.pixels.copy(), sky()), vmlight.make_lightmap(vismap, sky()))

    def test_channels_by_name(self):
        image = vmlight.make_vismap(plane(), resolution=8, channels=["normal", "coverage"])
        self.assertEqual(image["visibility"].shape, (8, 8))
        self.assert_same(image["normal"], np.broadcast_to(np.float32([0, 1, 0]), (8, 8, 3)))
        with self.assertRaisesRegex(KeyError, "no channel .*depth.*; there are visibility, direction.x"):
            image["depth"]

    def test_metadata(self):
        image = vmlight.Image(sky(), metadata={"text": "a", "whole": 3, "part": 0.5, "four": (1, 2, 3, 4)})
        self.assertEqual(image.metadata, {"text": "a", "whole": 3, "part": 0.5, "four": (1, 2, 3, 4)})
        with self.assertRaisesRegex(ValueError, "metadata: x: more than an integer of 32 bits"):
            vmlight.Image(sky(), metadata={"x": 1 << 40})
        with self.assertRaisesRegex(TypeError, "metadata: x: must be a number"):
            vmlight.Image(sky(), metadata={"x": object()})
        vismap = vmlight.make_vismap(plane(), resolution=8, samples=32)
        self.assertEqual(vismap.metadata["vmlight:samples"], "32")
        self.assertEqual(vismap.metadata["vmlight:mesh"], "plane")
        self.assertIn("8x8 vismap", repr(vismap))

    def test_a_stored_image_is_read_as_it_was_written(self):
        path = os.path.join(self.folder(), "stack.exr")
        stack = vmlight.make_cfem(STUDIO, stack=True, resolution=(16, 8))
        stack.write(path)
        read = vmlight.Image.read(path)
        self.assertEqual(len(read.subimages), 10)
        for one, other in zip(read.subimages, stack.subimages):
            self.assert_same(one, other)
        self.assertEqual(read.metadata["vmlight:stage"], "cfem")
        before = os.stat(path)
        with self.assertRaisesRegex(ValueError, "must be .exr"):
            stack.write(path + ".png")
        with self.assertRaises(FileNotFoundError):
            stack.write(os.path.join(path, "..", "absent", "x.exr"))
        with self.assertRaisesRegex(vmlight.Error, "half"):
            vmlight.Image(sky() * np.float32(1e6)).write(path, format="half")
        self.assertEqual(os.stat(path).st_mtime_ns, before.st_mtime_ns)

    def test_recipes_are_images(self):
        path = os.path.join(self.folder(), "studio.cfem")
        with open(path, "w") as file:
            file.write(f'environment = "{STUDIO}"\nresolution = "16x8"\n')
        self.assert_same(vmlight.Image.read(path), vmlight.make_cfem(STUDIO, resolution=16))


@unittest.skipUnless(OpenImageIO, "Python's module OpenImageIO is not installed")
class ImageBufs(Case):
    def image_buf(self, array, kind="float"):
        height, width, channels = array.shape
        image = OpenImageIO.ImageBuf(OpenImageIO.ImageSpec(width, height, channels, kind))
        self.assertTrue(image.set_pixels(OpenImageIO.ROI(), np.ascontiguousarray(array)))
        return image

    def test_image_bufs_are_inputs(self):
        expected = vmlight.make_cfem(sky())
        self.assert_same(vmlight.make_cfem(self.image_buf(sky())), expected)
        self.assert_same(vmlight.Image(self.image_buf(sky())), sky())
        half = self.image_buf(sky(), "half")
        self.assert_same(vmlight.make_cfem(half), vmlight.make_cfem(sky().astype(np.float16)))
        file = OpenImageIO.ImageBuf(STUDIO)
        self.assertEqual(vmlight.make_cfem(file).pixels.shape, (64, 128, 3))

    def test_image_bufs_may_change_after_the_call(self):
        light = self.image_buf(sky())
        image, relighter = vmlight.Image(light), vmlight.Relighter(vmlight.make_vismap(plane(), resolution=8), light)
        lit = relighter.light().pixels.copy()
        light.reset(OpenImageIO.ImageSpec(1, 1, 3, "float"))
        self.assert_same(image, sky())
        self.assert_same(relighter.light(), lit)

    def test_empty_image_bufs_are_refused(self):
        for empty in OpenImageIO.ImageBuf(), OpenImageIO.ImageBuf("absent.exr"):
            with self.assertRaisesRegex(ValueError, "environment: "):
                vmlight.make_cfem(empty)

    def test_an_image_buf_has_names_of_its_own(self):
        with self.assertRaisesRegex(TypeError, "an ImageBuf has its own"):
            vmlight.Image(self.image_buf(sky()), channels=["X", "Y", "Z"])

    def test_results_are_image_bufs(self):
        image = vmlight.make_cfem(STUDIO, resolution=(16, 8))
        buffer = image.to_imagebuf()
        self.assertIsInstance(buffer, OpenImageIO.ImageBuf)
        self.assert_same(buffer.get_pixels(), image)
        self.assertEqual(buffer.spec().channelnames, image.channels)
        self.assertEqual(buffer.spec().getattribute("vmlight:stage"), "cfem")
        del image
        gc.collect()
        self.assertEqual(buffer.spec().width, 16)
        self.assert_same(vmlight.make_lightmap(vmlight.make_vismap(plane(), resolution=8), buffer).channels, ("R", "G", "B"))

    def test_a_module_of_another_build_is_read_by_its_methods(self):
        class Entry:
            name, value = "vmlight:stage", "cfem"

        class Spec:
            channelnames, extra_attribs = ("R", "G", "B"), [Entry]

        class Foreign:
            def spec(self):
                return Spec

            def get_pixels(self):
                return sky()

        image = vmlight.Image(Foreign())
        self.assert_same(image, sky())
        self.assertEqual((image.channels, image.metadata), (("R", "G", "B"), {"vmlight:stage": "cfem"}))


if __name__ == "__main__":
    unittest.main()
