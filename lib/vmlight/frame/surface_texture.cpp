// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/surface_texture.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color_labels.h>
#include <vmlight/image/image_file.h>
#include <vmlight/lightmap/lightmap_check.h>
#include <vmlight/uv/udim.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {
namespace {

// The tile of a uv, which is moved into it: from v up to rows from the top.
int to_tile(TextureFootprint& at)
{
    // An island that ends on the border of a tile belongs to it.
    const auto cell = [](double x) {
        const double floor = std::floor(x);
        return x - floor < kUdimBorder && floor > 0 ? floor - 1 : floor;
    };
    const double u = cell(at.st.x), v = cell(at.st.y);
    at.st = { at.st.x - u, 1 - (at.st.y - v) };
    at.dx.y = -at.dx.y;
    at.dy.y = -at.dy.y;
    return u >= 0 && u < 10 && v >= 0 && v < 900 ? kFirstUdim + int(u) + 10 * int(v) : 0;
}

} // namespace

const TexturePyramid* TileTexture::tile(int udim) const
{
    const auto found = m_tiles.find(udim);
    return found == m_tiles.end() ? nullptr : &found->second;
}

bool TileTexture::lookup(const TextureFootprint& uv, float* dst, std::string&) const
{
    TextureFootprint at = uv;
    const int udim = to_tile(at);
    const TexturePyramid* image = tile(udim);
    if (!image) { // on the border of two tiles, the other one
        at = uv;
        const double u = std::floor(uv.st.x), v = std::floor(uv.st.y);
        image = u >= 0 && u < 10 && v >= 0 && v < 900 ? tile(kFirstUdim + int(u) + 10 * int(v)) : nullptr;
        at.st = { uv.st.x - u, 1 - (uv.st.y - v) };
        at.dx.y = -at.dx.y;
        at.dy.y = -at.dy.y;
    }
    if (image)
        image->lookup(at, dst);
    else
        std::fill_n(dst, m_channels, 0.0f);
    return true;
}

bool FileTexture::open_tile(int udim, const std::string& file, std::string& error)
{
    const auto in = open_image(file, error);
    if (!in)
        return false;
    std::array<int, 3> channels;
    error = lightmap_fault(in->spec());
    if (!error.empty() || !find_color_channels(in->spec(), channels, error)) {
        error = format("\"{}\": {}", file, error);
        return false;
    }
    const bool is_gray = channels[1] == channels[0];
    if (channels[0] != 0 || (!is_gray && (channels[1] != 1 || channels[2] != 2))) {
        error
            = format("\"{}\": its colour must be the first channels, R G B; the texture system reads no others", file);
        return false;
    }
    // The texture system reports a cut in what maketx writes.
    const bool is_plain_tiff = in->format_name() == std::string("tiff") && !in->seek_subimage(0, 1);
    if (is_plain_tiff && !is_whole_tiff(file, 0, error))
        return false;
    m_is_integer = is_integer(in->spec().format);
    m_tiles[udim] = { OIIO::ustring(file), is_gray };
    return true;
}

bool FileTexture::open(const std::string& name, std::string& error)
{
    m_tiles.clear();
    error.clear();
    if (has_udim_pattern(name)) {
        for (const int udim : existing_udims(name))
            if (!open_tile(udim, udim_path(name, udim), error))
                return false;
        if (m_tiles.empty())
            error = format("\"{}\": no files match", name);
    } else {
        open_tile(0, name, error);
    }
    if (!error.empty())
        return false;
    m_system = oiio::private_texture_system();
    m_system->attribute("max_memory_MB", 1024.0f);
    m_system->attribute("automip", 1);
    m_system->attribute("autotile", 64);
    m_system->attribute("accept_unmipped", 1);
    m_system->attribute("accept_untiled", 1);
    return true;
}

bool FileTexture::lookup(const TextureFootprint& uv, float* dst, std::string& error) const
{
    TextureFootprint at = uv;
    auto tile = m_tiles.find(0);
    if (tile == m_tiles.end()) {
        tile = m_tiles.find(to_tile(at));
    } else {
        at.st.y = 1 - at.st.y;
        at.dx.y = -at.dx.y;
        at.dy.y = -at.dy.y;
    }
    std::fill_n(dst, 3, 0.0f);
    if (tile == m_tiles.end())
        return true;
    OIIO::TextureOpt options;
    options.swrap = options.twrap = OIIO::TextureOpt::WrapClamp;
    options.interpmode = OIIO::TextureOpt::InterpBilinear;
    options.mipmode = OIIO::TextureOpt::MipModeTrilinear;
    const auto& [file, is_gray] = tile->second;
    if (!m_system->texture(file, options, float(at.st.x), float(at.st.y), float(at.dx.x), float(at.dx.y),
                           float(at.dy.x), float(at.dy.y), is_gray ? 1 : 3, dst)) {
        error = format("\"{}\": {}", file.string(), oiio::error_line(*m_system));
        return false;
    }
    if (is_gray)
        dst[1] = dst[2] = dst[0];
    return true;
}

} // namespace vmlight
