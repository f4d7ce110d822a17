// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/picture_file.h>

#include <vmlight/base/format.h>
#include <vmlight/base/interrupt.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/output_file.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>

namespace vmlight {
namespace {

struct PictureFormat
{
    const char *extension, *oiio_name;
    bool has_alpha, is_animation;
};
constexpr std::array<PictureFormat, 6> kPictureFormats { { { "png", "png", true, false },
                                                           { "jpg", "jpeg", false, false },
                                                           { "jpeg", "jpeg", false, false },
                                                           { "webp", "webp", true, false },
                                                           { "tif", "tiff", true, false },
                                                           { "gif", "gif", true, true } } };

const PictureFormat* format_of(const std::string& path)
{
    const std::string extension = OIIO::Strutil::lower(OIIO::Filesystem::extension(path, false));
    const auto found = std::find_if(kPictureFormats.begin(), kPictureFormats.end(),
                                    [&](const PictureFormat& format) { return extension == format.extension; });
    return found == kPictureFormats.end() ? nullptr : &*found;
}

// What a writer of 8 bit gets: rounding is its own.
OIIO::ImageSpec spec_for(const OIIO::ImageBuf& picture, const PictureFormat& format)
{
    const OIIO::ImageSpec& source = picture.spec();
    const bool with_alpha = format.has_alpha && source.alpha_channel == 3;
    OIIO::ImageSpec spec(source.width, source.height, with_alpha ? 4 : 3, OIIO::TypeUInt8);
    spec.extra_attribs = source.extra_attribs;
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("CompressionQuality", 95);
    // OIIO writes the current time into a TIFF unless DateTime is set.
    spec.attribute("DateTime", "");
    return spec;
}

// The channels that are written, on black where the format has no alpha.
OIIO::ImageBuf prepared(const OIIO::ImageBuf& picture, const OIIO::ImageSpec& spec)
{
    OIIO::ImageBuf image = OIIO::ImageBufAlgo::channels(picture, spec.nchannels, {}).copy(OIIO::TypeFloat);
    if (spec.nchannels == 3 && picture.spec().alpha_channel == 3) {
        for (OIIO::ImageBuf::Iterator<float> pixel(image); !pixel.done(); ++pixel) {
            const float alpha = picture.getchannel(pixel.x(), pixel.y(), 0, 3);
            for (int c = 0; c < 3; ++c)
                pixel[c] = pixel[c] * alpha;
        }
    }
    return image;
}

bool write(OIIO::cspan<OIIO::ImageBuf> pictures, const std::string& path, double fps, std::string& error)
{
    const PictureFormat* format_found = format_of(path);
    error = !format_found ? format("\"{}\": the extension of a picture must be png, jpg, webp, tif or gif", path)
                          : output_file_fault(path);
    if (!error.empty())
        return false;
    const DeferInterrupts writing;
    // By name: most writers take no proxy.
    OutputFile file(path, TemporaryFileKind::Hidden);
    const auto out = OIIO::ImageOutput::create(format_found->oiio_name);
    if (!out || !file.ok()) {
        error = format("\"{}\": {}", path, out ? file.reason() : oiio::error_line());
        return false;
    }
    // OIIO 2.4 compresses TIFF on several threads and corrupts memory.
    out->threads(1);
    bool good = true;
    for (int i = 0; good && i < int(pictures.size()); ++i) {
        OIIO::ImageSpec spec = spec_for(pictures[i], *format_found);
        if (format_found->is_animation && fps > 0)
            spec.attribute("FramesPerSecond", float(fps));
        good = out->open(file.temporary_path(), spec,
                         i == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage)
            && out->write_image(OIIO::TypeFloat, prepared(pictures[i], spec).localpixels());
    }
    good = out->close() && good;
    if (good && file.commit())
        return true;
    error = format("\"{}\": {}", path, good ? file.reason() : oiio::error_line(*out));
    return false;
}

} // namespace

bool is_picture_name(const std::string& path)
{
    return format_of(path) != nullptr;
}

bool is_animation_name(const std::string& path)
{
    const PictureFormat* found = format_of(path);
    return found && found->is_animation;
}

bool write_picture(const OIIO::ImageBuf& picture, const std::string& path, std::string& error)
{
    return write(OIIO::cspan<OIIO::ImageBuf>(&picture, 1), path, 0, error);
}

bool write_animation(const std::vector<OIIO::ImageBuf>& pictures, const std::string& path, double fps,
                     std::string& error)
{
    return write(pictures, path, fps, error);
}

} // namespace vmlight
