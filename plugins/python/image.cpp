// SPDX-License-Identifier: Apache-2.0
#include "image.h"

#include "arguments.h"
#include "function.h"
#include "messages.h"
#include "metadata.h"
#include "work.h"

#include <vmlight/base/format.h>
#include <vmlight/image/image_file.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/vismap/basis.h>

#include <OpenImageIO/strutil.h>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>

namespace vmlight::python {
namespace {

py::array_t<float> pixels_of(const py::object& self)
{
    const Image& image = py::cast<const Image&>(self);
    const OIIO::ImageSpec& spec = image.first().spec();
    // The array keeps `self`, and with it the memory.
    py::array_t<float> pixels({ spec.height, spec.width, spec.nchannels },
                              static_cast<const float*>(image.first().localpixels()), self);
    if (image.is_readonly)
        pixels.attr("setflags")(py::arg("write") = false);
    return pixels;
}

py::buffer_info buffer_of(Image& image)
{
    const OIIO::ImageSpec& spec = image.first().spec();
    const std::vector<py::ssize_t> shape { spec.height, spec.width, spec.nchannels };
    const std::vector<py::ssize_t> strides { py::ssize_t(sizeof(float)) * spec.width * spec.nchannels,
                                             py::ssize_t(sizeof(float)) * spec.nchannels, sizeof(float) };
    return { const_cast<void*>(image.first().localpixels()),
             sizeof(float),
             py::format_descriptor<float>::format(),
             3,
             shape,
             strides,
             image.is_readonly };
}

// A channel, or those whose names it begins: "direction" is direction.x, .y and .z.
py::object channel_of(const py::object& self, const std::string& name)
{
    const std::vector<std::string>& names = py::cast<const Image&>(self).first().spec().channelnames;
    const auto is_part = [&](const std::string& channel) { return OIIO::Strutil::starts_with(channel, name + "."); };
    const auto only = std::find(names.begin(), names.end(), name);
    const auto first = std::find_if(names.begin(), names.end(), is_part);
    if (only == names.end() && first == names.end())
        throw py::key_error(format("no channel \"{}\"; there are {}", name, OIIO::Strutil::join(names, ", ")));
    const py::ssize_t begin = (only == names.end() ? first : only) - names.begin();
    const py::ssize_t end = std::find_if_not(first, names.end(), is_part) - names.begin();
    const py::object last = only == names.end() ? py::object(py::slice(begin, end, 1)) : py::object(py::int_(begin));
    return pixels_of(self)[py::make_tuple(py::ellipsis(), last)];
}

py::tuple subimages_of(const Image& image)
{
    py::tuple parts(image.parts.size());
    for (size_t i = 0; i < image.parts.size(); ++i)
        parts[i] = Image { { image.parts[i] }, image.is_readonly };
    return parts;
}

std::string repr_of(const Image& image)
{
    const OIIO::ImageSpec& spec = image.first().spec();
    const std::string stage = spec.get_string_attribute("vmlight:stage");
    return format("<vmlight.Image {}x{} {}{}{}>", spec.width, spec.height, stage, stage.empty() ? "" : " ",
                  spec.nchannels > 4 ? format("{} channels", spec.nchannels)
                                     : OIIO::Strutil::join(spec.channelnames, ","));
}

Image read_image(const std::string& path, const WorkOptions& options)
{
    std::vector<OIIO::ImageBuf> images;
    do_work(options, { path }, [&](const MakeOptions& given, std::string& error) {
        MakeOptions make = given;
        if (is_recipe_name(path))
            make.chain.push_back(path);
        const PixelSourcePointer source = open_source(path, error);
        return source && source->make(images, { 0, source->subimages() }, make, error);
    });
    return own(std::move(images));
}

void write_image_file(const Image& image, const std::string& path, const FileParams& file, const WorkOptions& options)
{
    if (const std::string fault = output_name_fault(path); !fault.empty())
        throw py::value_error(fault);
    const size_t slash = path.rfind('/');
    do_work(options, { slash == std::string::npos ? "" : path.substr(0, slash + 1) },
            [&](const MakeOptions& given, std::string& error) {
                const std::vector<OIIO::ImageBuf> views = views_of(image);
                for (const OIIO::ImageBuf& view : views)
                    if (file.format == "half" && !(error = half_fault(view.spec())).empty())
                        return false;
                return write_images(views, path, file, given.progress("write", 0), error);
            });
}

const char* const kMaking
    = "An image over an array of floats, which is not copied if it is float32 and row by row; or a copy of an "
      "OpenImageIO.ImageBuf.";

std::vector<std::string> channel_names(const py::object& names)
{
    if (names.is_none())
        return {};
    if (!PySequence_Check(names.ptr()) || py::isinstance<py::str>(names))
        throw py::type_error(format("channels: must be a sequence of str, not {}", Py_TYPE(names.ptr())->tp_name));
    std::vector<std::string> dst;
    for (py::handle name : names)
        dst.push_back(str_text("channels", name));
    return dst;
}

// The operands pixels, channels and metadata.
Image make_from_pixels(const std::vector<py::object>& operands)
{
    const py::object &pixels = operands[0], &metadata = operands[2];
    if (!is_array(pixels)) {
        if (!operands[1].is_none() || !metadata.is_none())
            throw py::type_error("channels and metadata are for arrays: an ImageBuf has its own");
        return input_image("pixels", pixels, {}, true);
    }
    if (!metadata.is_none() && !py::isinstance<py::dict>(metadata))
        throw py::type_error(format("metadata: must be a dict, not {}", Py_TYPE(metadata.ptr())->tp_name));
    return image_of_array("pixels", pixels, channel_names(operands[1]),
                          metadata.is_none() ? py::dict() : py::dict(metadata));
}

const char* const kImage = R"(An image in memory: pixels, names of channels, metadata. What the functions of vmlight
take and return.

numpy sees the pixels without a copy: image.pixels, numpy.asarray(image), and
image["visibility"] or image["direction"] for channels by name.)";

} // namespace

void define_image(py::module_& m)
{
    const Signature<NoParams> making(
        { "Image",
          FunctionKind::constructor,
          kMaking,
          { { "pixels", "NDArray[Any] | ImageBuf", "Floats, (height, width, channels) or (height, width)" },
            { "channels", "Sequence[str] | None", "Their names; None: Y, R G B or R G B A", "None" },
            { "metadata", "dict[str, Any] | None", "Numbers, text, and sequences of floats", "None" } },
          "",
          "" },
        {}, false);
    const Signature<NoParams> reading(
        { "read",
          FunctionKind::static_method,
          "Read an image file, all of its parts, or make the image of a recipe (.vismap, .cfem, .lightmap).",
          { { "path", "StrPath", "What OpenImageIO opens, or a recipe" } },
          "Image",
          "with float pixels, as stored" });
    const Signature<FileParams> writing(
        { "write",
          FunctionKind::method,
          "Write an EXR, as the executables do: whole or not at all, and the same bytes for the same image.",
          { { "path", "StrPath", "A name that ends in .exr" } },
          "None",
          "" });

    py::class_<Image> image(m, "Image", py::buffer_protocol(), kImage);
    image.attr("__module__") = "vmlight";
    image
        .def(py::init([making](const py::args& args, const py::kwargs& kwargs) {
                 return make_from_pixels(making.read(args, kwargs).first.operands);
             }),
             docstring(making.function()).c_str())
        .def_buffer(&buffer_of)
        .def_property_readonly("pixels", &pixels_of, "The pixels, (height, width, channels) of float32: no copy.")
        .def_property_readonly(
            "channels", [](const Image& self) { return py::tuple(py::cast(self.first().spec().channelnames)); },
            "Names of the channels.")
        .def_property_readonly(
            "metadata", [](const Image& self) { return metadata_of(self.first().spec()); },
            "All metadata, such as vmlight:samples: a copy.")
        .def_property_readonly("subimages", &subimages_of,
                               "The images of a stack, of which this shows the first; else this image alone.")
        .def("__getitem__", &channel_of, py::arg("channel"),
             "__getitem__(self, channel)\n--\n\nThe pixels of a channel, (height, width); or of those whose names it "
             "begins, as direction for direction.x, .y and .z, (height, width, 3). No copy.")
        .def(
            "to_imagebuf",
            [](const Image& self) {
                py::module_::import("OpenImageIO");
                if (!py::detail::get_type_info(typeid(OIIO::ImageBuf), false))
                    throw_error("this OpenImageIO module is of another build than vmlight, which cannot make its "
                                "images: write a file, or use set_pixels()");
                return self.first().copy(OIIO::TypeFloat);
            },
            "to_imagebuf(self)\n--\n\nA copy as OpenImageIO.ImageBuf, with channels and metadata.")
        .def("__repr__", &repr_of);
    image.def_static(
        "read",
        [reading](const py::args& args, const py::kwargs& kwargs) {
            const Call call = reading.read(args, kwargs).first;
            return read_image(path_text("path", call.operands[0]), call.work);
        },
        docstring(reading.function()).c_str());
    image.def(
        "write",
        [writing](const Image& self, const py::args& args, const py::kwargs& kwargs) {
            const auto [call, params] = writing.read(args, kwargs);
            write_image_file(self, path_text("path", call.operands[0]), params, call.work);
        },
        docstring(writing.function()).c_str());
    add_to_table("Image.__init__", making.function());
    add_to_table("Image.read", reading.function());
    add_to_table("Image.write", writing.function());
}

} // namespace vmlight::python
