// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/texture_file.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <vector>

namespace vmlight {
namespace {

bool encode_texture(std::string& bytes, const OIIO::ImageBuf& texture, const char* writer, OIIO::TypeDesc type,
                    std::string& error)
{
    OIIO::ImageSpec spec(texture.spec().width, texture.spec().height, texture.nchannels(), type);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("oiio:ColorSpace", ""); // without it OIIO 3 marks PNG as sRGB
    const auto out = OIIO::ImageOutput::create(writer);
    if (!out || !out->supports("ioproxy")) {
        error = format("OpenImageIO cannot write {}: {}", writer, out ? "to memory" : oiio::error_line());
        return false;
    }
    std::vector<unsigned char> buffer;
    OIIO::Filesystem::IOVecOutput file(buffer);
    const OIIO::ImageBuf floats = texture.copy(OIIO::TypeFloat);
    bool good = out->set_ioproxy(&file) && out->open("texture." + std::string(writer), spec)
        && out->write_image(OIIO::TypeFloat, floats.localpixels());
    good = out->close() && good;
    if (!good) {
        error = oiio::error_line(*out);
        return false;
    }
    bytes.assign(buffer.begin(), buffer.end());
    return true;
}

} // namespace

double largest_of(TextureDepth depth)
{
    return depth == TextureDepth::Eight ? 255 : 65535;
}

bool encode_png(std::string& bytes, const OIIO::ImageBuf& texture, TextureDepth depth, std::string& error)
{
    return encode_texture(bytes, texture, "png",
                          depth == TextureDepth::Eight ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16, error);
}

bool encode_rgbe(std::string& bytes, const OIIO::ImageBuf& texture, std::string& error)
{
    return encode_texture(bytes, texture, "hdr", OIIO::TypeDesc::FLOAT, error);
}

} // namespace vmlight
