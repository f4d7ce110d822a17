// SPDX-License-Identifier: Apache-2.0
/// Images that Python and the library share: pixels are numpy arrays over the same memory.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vmlight::python {

namespace py = pybind11;

/// Shared with whoever sees the pixels, and what owns them: an array, another module's ImageBuf.
using SharedImage = std::shared_ptr<OIIO::ImageBuf>;

/// vmlight.Image: one image, or those of a stack, of which the first stands for all. Each has float pixels in memory.
struct Image
{
    std::vector<SharedImage> parts;
    bool is_readonly = false; ///< over an array that is

    const OIIO::ImageBuf& first() const { return *parts.front(); }
};

/// An Image of what the library made.
Image own(std::vector<OIIO::ImageBuf> images);
Image own_one(OIIO::ImageBuf image);

/// What a function works on: a vmlight.Image, an array of floats, or an OpenImageIO.ImageBuf. None of them is copied if
/// its memory can be used as it is: float32, row by row. Throws TypeError and ValueError, which name the argument.
///
/// @param channels names of the channels of an array that has as many; others get Y, R, G, B or R, G, B, A
/// @param is_kept  whether it is used after the call: an ImageBuf, which Python may change, is then copied
Image input_image(const char* name, py::handle value, const std::vector<std::string>& channels = {},
                  bool is_kept = false);

/// Whether a value is an array, or says how it can be one.
bool is_array(py::handle value);

/// The same for an array, with names and metadata of its own. Empty `channels`: as for input_image(), with `expected`.
Image image_of_array(const char* name, py::handle value, std::vector<std::string> channels, const py::dict& metadata,
                     const std::vector<std::string>& expected = {});

/// An image over the pixels of another, which must outlive it.
OIIO::ImageBuf view_of(const OIIO::ImageBuf& image);
/// Views of all parts, one after the other, as the library takes a stack.
std::vector<OIIO::ImageBuf> views_of(const Image& image);

/// The type hint of what input_image() takes.
inline constexpr const char* kImageHint = "Image | NDArray | ImageBuf";

/// Add vmlight.Image.
void define_image(py::module_& m);

} // namespace vmlight::python
