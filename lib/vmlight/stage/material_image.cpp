// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/material_image.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/image/file_claims.h>
#include <vmlight/image/image_file.h>

#include <algorithm>
#include <array>

namespace vmlight {
namespace {

// Image files that OIIO reads from memory, by how they begin.
struct ImageFormat
{
    const char *begins, *name;
};
constexpr std::array<ImageFormat, 3> kEmbeddedFormats {
    { { "\x89PNG", "texture.png" }, { "\xff\xd8\xff", "texture.jpg" }, { "\x76\x2f\x31\x01", "texture.exr" } }
};

bool read_bytes(std::string& dst, const MaterialTexture& texture, std::string& error)
{
    if (texture.embedded) {
        dst = *texture.embedded;
        return true;
    }
    dst.resize(texture.length);
    if (OIIO::Filesystem::read_bytes(texture.path, dst.data(), dst.size(), texture.offset) == dst.size())
        return true;
    error = format("\"{}\": cannot read the texture in it", texture.path);
    return false;
}

} // namespace

bool MaterialImage::open_embedded(const MaterialTexture& texture, std::string& error)
{
    if (!read_bytes(m_bytes, texture, error))
        return false;
    const auto format_of
        = std::find_if(kEmbeddedFormats.begin(), kEmbeddedFormats.end(), [&](const ImageFormat& format) {
              return m_bytes.compare(0, std::char_traits<char>::length(format.begins), format.begins) == 0;
          });
    if (format_of == kEmbeddedFormats.end()) {
        error = format("\"{}\": a texture in it is neither PNG, JPEG nor EXR", texture.path);
        return false;
    }
    m_memory = std::make_unique<OIIO::Filesystem::IOMemReader>(m_bytes.data(), m_bytes.size());
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    // OIIO 2.4 forgets a proxy that comes beside hints.
    OIIO::Filesystem::IOProxy* proxy = m_memory.get();
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    m_in = OIIO::ImageInput::open(format_of->name, &config, proxy);
    if (!m_in)
        error = format("\"{}\": a texture in it: {}", texture.path, oiio::error_line());
    return m_in != nullptr;
}

bool MaterialImage::open(const MaterialTexture& texture, std::string& error)
{
    m_path = texture.path;
    if (texture.embedded || texture.length > 0) {
        if (!open_embedded(texture, error))
            return false;
        error = header_fault(m_in->spec());
        return error.empty();
    }
    if (!may_be_image(m_path)) {
        error = format("\"{}\": {}", m_path, OIIO::Filesystem::exists(m_path) ? "not a file" : "no such file");
        return false;
    }
    std::string fault = claims_fault(m_path);
    if (fault.empty()) {
        m_in = open_image(m_path, error);
        if (!m_in)
            return false;
        fault = header_fault(m_in->spec());
    }
    if (!fault.empty())
        error = format("\"{}\": {}", m_path, fault);
    return fault.empty();
}

bool MaterialImage::read(int first, int end, float* dst, std::string& error)
{
    if (oiio::has_read(*m_in, m_in->read_image(0, 0, first, end, OIIO::TypeFloat, dst)))
        return true;
    const std::string reason = oiio::pixels_error(oiio::error_line(*m_in));
    error = m_memory ? format("\"{}\": a texture in it: {}", m_path, reason) : oiio::with_path(m_path, reason);
    return false;
}

bool MaterialImage::read_all(OIIO::ImageBuf& dst, const MaterialTexture& texture, int channels, std::string& error,
                             OIIO::TypeDesc* stored)
{
    MaterialImage image;
    if (!image.open(texture, error))
        return false;
    OIIO::ImageSpec spec = image.spec();
    if (stored)
        *stored = spec.format;
    spec.nchannels = std::min(spec.nchannels, channels);
    spec.set_format(OIIO::TypeFloat);
    spec.channelnames.resize(size_t(spec.nchannels));
    spec.channelformats.clear();
    spec.alpha_channel = spec.alpha_channel < spec.nchannels ? spec.alpha_channel : -1;
    error = memory_shortage(spec);
    if (!error.empty())
        error = format("\"{}\": {}", texture.path, error);
    else if (spec.depth > 1 || spec.width < 1 || spec.height < 1)
        error = format("\"{}\": {}x{}x{} pixels; a texture is flat", texture.path, spec.width, spec.height, spec.depth);
    if (!error.empty())
        return false;
    dst.reset(spec, OIIO::InitializePixels::No);
    if (!dst.localpixels()) {
        error = format("\"{}\": out of memory for {}x{} pixels", texture.path, spec.width, spec.height);
        return false;
    }
    return image.read(0, spec.nchannels, static_cast<float*>(dst.localpixels()), error);
}

} // namespace vmlight
