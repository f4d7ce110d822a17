// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/surface_texture.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/image_file.h>
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

bool FileTexture::open(const std::string& name, std::string& error)
{
    m_name = name;
    m_file = OIIO::ustring(name);
    m_is_udim = has_udim_pattern(name);
    std::string first = name;
    if (m_is_udim) {
        const std::vector<int> tiles = existing_udims(name);
        if (tiles.empty()) {
            error = format("\"{}\": no files match", name);
            return false;
        }
        first = udim_path(name, tiles[0]);
    }
    const auto in = open_image(first, error);
    if (!in)
        return false;
    std::array<int, 3> channels;
    if (!find_color_channels(in->spec(), channels, error)) {
        error = format("\"{}\": {}", first, error);
        return false;
    }
    m_is_gray = channels[1] == channels[0];
    if (channels[0] != 0 || (!m_is_gray && (channels[1] != 1 || channels[2] != 2))) {
        error
            = format("\"{}\": its colour must be the first channels, R G B; the texture system reads no others", first);
        return false;
    }
    // A system of its own: others may have other limits.
    m_system.reset(OIIO::TextureSystem::create(false),
                   [](OIIO::TextureSystem* system) { OIIO::TextureSystem::destroy(system); });
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
    if (!m_is_udim) {
        at.st.y = 1 - at.st.y;
        at.dx.y = -at.dx.y;
        at.dy.y = -at.dy.y;
    }
    OIIO::TextureOpt options;
    options.swrap = options.twrap = OIIO::TextureOpt::WrapClamp;
    options.interpmode = OIIO::TextureOpt::InterpBilinear;
    options.mipmode = OIIO::TextureOpt::MipModeTrilinear;
    const bool good = m_system->texture(m_file, options, float(at.st.x), float(at.st.y), float(at.dx.x), float(at.dx.y),
                                        float(at.dy.x), float(at.dy.y), m_is_gray ? 1 : 3, dst);
    if (!good) {
        error = format("\"{}\": {}", m_name, m_system->geterror());
        return false;
    }
    if (m_is_gray)
        dst[1] = dst[2] = dst[0];
    return true;
}

} // namespace vmlight
