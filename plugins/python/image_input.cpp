// SPDX-License-Identifier: Apache-2.0
#include "arguments.h"
#include "image.h"
#include "messages.h"
#include "metadata.h"

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

namespace vmlight::python {
namespace {

constexpr py::ssize_t kMaxSide = 1 << 20, kMaxChannels = 1024;

// `image` for as long as someone holds it, and `owner` with it. The last holder may be a thread without the
// interpreter's lock.
SharedImage shared_with(std::unique_ptr<OIIO::ImageBuf> image, py::object owner)
{
    PyObject* const kept = owner.release().ptr();
    return { image.release(), [kept](OIIO::ImageBuf* dst) {
                delete dst;
                if (Py_IsInitialized()) {
                    const py::gil_scoped_acquire locked;
                    Py_DECREF(kept);
                }
            } };
}

std::vector<std::string> default_channels(int count, const std::vector<std::string>& expected)
{
    if (count == int(expected.size()))
        return expected;
    static const std::vector<std::string> names { "R", "G", "B", "A" };
    if (count == 1)
        return { "Y" };
    return count == 3 || count == 4 ? std::vector<std::string>(names.begin(), names.begin() + count)
                                    : std::vector<std::string>();
}

// Whether numpy.require() leaves it as it is.
bool is_usable(const py::array& array)
{
    return py::isinstance<py::array_t<float, py::array::c_style>>(array)
        && (array.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_) != 0;
}

// Of another module that is built with the same pybind11 and the same OpenImageIO, as Debian's is; or by its methods.
Image image_of_imagebuf(const char* name, const py::object& value, bool is_kept)
{
    if (!py::isinstance<OIIO::ImageBuf>(value)) {
        const py::object spec = value.attr("spec")();
        py::dict metadata;
        for (py::handle entry : spec.attr("extra_attribs"))
            metadata[entry.attr("name")] = entry.attr("value");
        return image_of_array(name, value.attr("get_pixels")(),
                              py::cast<std::vector<std::string>>(spec.attr("channelnames")), metadata, {});
    }
    const OIIO::ImageBuf& image = py::cast<const OIIO::ImageBuf&>(value);
    auto copy = std::make_shared<OIIO::ImageBuf>();
    bool is_shared = false, is_copied = false;
    {
        const py::gil_scoped_release unlocked; // either may read a file
        is_shared
            = !is_kept && image.localpixels() && image.spec().format == OIIO::TypeFloat && image.spec().depth == 1;
        if (!is_shared)
            is_copied
                = image.initialized() && !image.deep() && image.spec().depth == 1 && copy->copy(image, OIIO::TypeFloat);
    }
    if (is_shared)
        return { { shared_with(std::make_unique<OIIO::ImageBuf>(view_of(image)), value) } };
    if (!is_copied)
        throw py::value_error(format("{}: {}", name, image.has_error() ? oiio::error_line(image) : "not a flat image"));
    return { { copy } };
}

} // namespace

bool is_array(py::handle value)
{
    return py::isinstance<py::array>(value) || py::hasattr(value, "__array__")
        || py::hasattr(value, "__array_interface__");
}

Image image_of_array(const char* name, py::handle value, std::vector<std::string> channels, const py::dict& metadata,
                     const std::vector<std::string>& expected)
{
    const py::module_ numpy = py::module_::import("numpy");
    py::array array = numpy.attr("asarray")(value);
    if (array.dtype().kind() != 'f')
        throw py::type_error(format("{}: pixels must be floats, not {}; scale them first, as pixels / "
                                    "numpy.float32(255)",
                                    name, py::cast<std::string>(py::str(array.dtype()))));
    if (array.ndim() != 2 && array.ndim() != 3)
        throw py::value_error(format("{}: must have the shape (height, width) or (height, width, channels), not {}",
                                     name, py::cast<std::string>(py::str(array.attr("shape")))));
    const py::ssize_t height = array.shape(0), width = array.shape(1), count = array.ndim() == 3 ? array.shape(2) : 1;
    if (array.size() == 0 || height > kMaxSide || width > kMaxSide || count > kMaxChannels)
        throw py::value_error(format("{}: {} x {} pixels of {} channels: must be from 1 x 1 x 1 to {} x {} x {}", name,
                                     width, height, count, kMaxSide, kMaxSide, kMaxChannels));
    if (channels.empty())
        channels = default_channels(int(count), expected);
    if (py::ssize_t(channels.size()) != count)
        throw py::value_error(
            channels.empty() ? format("{}: has {} channels: name them, as Image(pixels, channels=[...])", name, count)
                             : format("{}: {} names for {} channels", name, channels.size(), count));
    OIIO::ImageSpec spec(int(width), int(height), int(count), OIIO::TypeFloat);
    spec.channelnames = channels;
    add_metadata(spec, metadata);
    if (!is_usable(array))
        if (const std::string shortage = memory_shortage(spec); !shortage.empty())
            throw_error(std::string(name) + ": " + shortage);
    array = numpy.attr("require")(array, "float32", "CA");
    // Nothing of the library writes to its inputs.
    auto image = std::make_unique<OIIO::ImageBuf>(spec, const_cast<void*>(array.data()));
    const bool is_readonly = !array.writeable();
    return { { shared_with(std::move(image), array) }, is_readonly };
}

Image own(std::vector<OIIO::ImageBuf> images)
{
    Image dst;
    for (OIIO::ImageBuf& image : images)
        dst.parts.push_back(std::make_shared<OIIO::ImageBuf>(std::move(image)));
    return dst;
}

Image own_one(OIIO::ImageBuf image)
{
    return { { std::make_shared<OIIO::ImageBuf>(std::move(image)) } };
}

Image input_image(const char* name, py::handle value, const std::vector<std::string>& channels, bool is_kept)
{
    if (py::isinstance<Image>(value))
        return py::cast<const Image&>(value);
    if (py::isinstance<OIIO::ImageBuf>(value) || py::hasattr(value, "get_pixels"))
        return image_of_imagebuf(name, py::reinterpret_borrow<py::object>(value), is_kept);
    if (is_array(value))
        return image_of_array(name, value, {}, {}, channels);
    throw py::type_error(format("{}: must be an image: {}, not {}", name, kImageHint, Py_TYPE(value.ptr())->tp_name));
}

OIIO::ImageBuf view_of(const OIIO::ImageBuf& image)
{
    return { image.spec(), const_cast<void*>(image.localpixels()) };
}

std::vector<OIIO::ImageBuf> views_of(const Image& image)
{
    std::vector<OIIO::ImageBuf> views;
    for (const SharedImage& part : image.parts)
        views.push_back(view_of(*part));
    return views;
}

} // namespace vmlight::python
