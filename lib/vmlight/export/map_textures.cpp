// SPDX-License-Identifier: Apache-2.0
#include <vmlight/export/map_textures.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace vmlight {
namespace {

using Imath::V3d;
using Imath::V3f;

V3f direction_of(const float* texel)
{
    return V3f(texel[1], texel[2], texel[3]);
}

bool sees_anything(const float* texel)
{
    return direction_of(texel) != V3f(0);
}

} // namespace

bool MapTexels::open(const OIIO::ImageBuf& map, const TexelSurface* surface, std::string& error)
{
    std::array<int, 4> index;
    const OIIO::ImageSpec& spec = map.spec();
    if (!find_vismap_channels(spec, index, error))
        return false;
    if (kernel_of(spec) == kStrandKernel) {
        error = "a visibility map of strands, which have no ambient occlusion or bent normal";
        return false;
    }
    if (map.roi() != map.roi_full()) {
        error = "only part of a map; a texture needs the whole map";
        return false;
    }
    m_width = spec.width;
    m_height = spec.height;
    m_surface = surface;
    const size_t count = size_t(m_width) * size_t(m_height), channels = size_t(spec.nchannels);
    const auto* pixels = static_cast<const float*>(map.localpixels());
    const int coverage = spec.channelindex(kCoverageChannel);
    std::array<int, 3> normal;
    std::transform(kNormalChannels.begin(), kNormalChannels.end(), normal.begin(),
                   [&](const char* name) { return spec.channelindex(name); });
    const bool has_normals = std::all_of(normal.begin(), normal.end(), [](int channel) { return channel >= 0; });
    m_texels.resize(4 * count);
    m_normals.resize(has_normals ? 3 * count : 0);
    m_charts.resize(coverage >= 0 && !surface ? count : 0);
    for (size_t i = 0; i < count; ++i) {
        for (size_t c = 0; c < 4; ++c) {
            m_texels[4 * i + c] = pixels[channels * i + size_t(index[c])];
            if (!std::isfinite(m_texels[4 * i + c])) {
                error = format("pixel ({}, {}) of channel {} is {}", i % size_t(m_width), i / size_t(m_width),
                               kVismapChannels[c], m_texels[4 * i + c]);
                return false;
            }
        }
        for (size_t c = 0; c < 3 && has_normals; ++c)
            m_normals[3 * i + c] = pixels[channels * i + size_t(normal[c])];
        if (!m_charts.empty())
            m_charts[i] = pixels[channels * i + size_t(coverage)];
    }
    return true;
}

OIIO::ImageBuf MapTexels::filled_map() const
{
    OIIO::ImageBuf image(OIIO::ImageSpec(m_width, m_height, 4, OIIO::TypeFloat));
    auto* texels = static_cast<float*>(image.localpixels());
    std::copy(m_texels.begin(), m_texels.end(), texels);
    if (!m_surface && m_charts.empty())
        return image;
    Coverage known = m_surface ? m_surface->coverage() : Coverage(m_width, m_height);
    for (int y = 0; y < m_height; ++y)
        for (int x = 0; x < m_width; ++x) {
            const size_t i = size_t(y) * size_t(m_width) + size_t(x);
            if (texels[4 * i] > 0 || sees_anything(&texels[4 * i]) || (!m_charts.empty() && m_charts[i] > 0))
                known.set(x, y);
        }
    fill_margin(texels, 4, known, -1);
    return image;
}

OIIO::ImageBuf MapTexels::occlusion() const
{
    const OIIO::ImageBuf map = filled_map();
    const auto* texels = static_cast<const float*>(map.localpixels());
    OIIO::ImageBuf image(OIIO::ImageSpec(m_width, m_height, 1, OIIO::TypeFloat));
    auto* dst = static_cast<float*>(image.localpixels());
    for (size_t i = 0; i < map.spec().image_pixels(); ++i)
        dst[i] = std::clamp(texels[4 * i], 0.0f, 1.0f);
    return image;
}

OIIO::ImageBuf MapTexels::normals(const TexelSurface& surface) const
{
    std::vector<float> texels(m_texels.size());
    surface.for_each([&](size_t i, const TangentSpace& frame) {
        const V3f normal = m_normals.empty() ? V3f(frame.normal.normalized())
                                             : V3f(m_normals[3 * i], m_normals[3 * i + 1], m_normals[3 * i + 2]);
        for (int axis = 0; axis < 3; ++axis)
            texels[4 * i + 1 + size_t(axis)] = normal[axis];
    });
    const Directions directions = filled(std::move(texels), surface.coverage());
    OIIO::ImageBuf image(OIIO::ImageSpec(m_width, m_height, 3, OIIO::TypeFloat));
    std::copy(directions.texels.begin(), directions.texels.end(), static_cast<V3f*>(image.localpixels()));
    return image;
}

MapTexels::Directions MapTexels::filled(std::vector<float> texels, Coverage known) const
{
    fill_margin(texels.data(), 4, known, -1);
    Directions result;
    result.texels.resize(texels.size() / 4);
    for (size_t i = 0; i < result.texels.size(); ++i) {
        const V3d b(direction_of(&texels[4 * i]));
        const double length = b.length();
        result.texels[i] = length > 0 ? V3f(b / length) : V3f(0, 0, 1);
    }
    return result;
}

MapTexels::Directions MapTexels::object_directions() const
{
    Coverage known(m_width, m_height);
    for (int y = 0; y < m_height; ++y)
        for (int x = 0; x < m_width; ++x)
            if (sees_anything(&m_texels[4 * (size_t(y) * size_t(m_width) + size_t(x))]))
                known.set(x, y);
    return filled(m_texels, known);
}

MapTexels::Directions MapTexels::tangent_directions() const
{
    // The margin of the map is in the object space of its neighbours: it is filled again, from their tangent space.
    std::vector<float> texels(m_texels.size());
    std::atomic<int64_t> behind { 0 };
    m_surface->for_each([&](size_t i, const TangentSpace& frame) {
        const V3d b(direction_of(&m_texels[4 * i])), local = frame.from_object(b);
        const double scale = local.length() > 0 ? b.length() / local.length() : 0;
        texels[4 * i] = m_texels[4 * i];
        for (int axis = 0; axis < 3; ++axis)
            texels[4 * i + 1 + size_t(axis)] = float(local[axis] * scale);
        if (local.z < 0)
            ++behind;
    });
    Coverage known(m_width, m_height);
    for (int y = 0; y < m_height; ++y)
        for (int x = 0; x < m_width; ++x)
            if (sees_anything(&texels[4 * (size_t(y) * size_t(m_width) + size_t(x))]))
                known.set(x, y);
    Directions result = filled(std::move(texels), known);
    result.behind = behind;
    return result;
}

void apply_ao_gamma(OIIO::ImageBuf& occlusion, double gamma)
{
    auto* v = static_cast<float*>(occlusion.localpixels());
    for (size_t i = 0; gamma != 1 && i < occlusion.spec().image_pixels(); ++i)
        v[i] = float(std::pow(double(v[i]), 1 / gamma));
}

OIIO::ImageBuf normal_texture(const MapTexels::Directions& directions, int width, int height, bool green_is_up)
{
    OIIO::ImageBuf image(OIIO::ImageSpec(width, height, 3, OIIO::TypeFloat));
    auto* dst = static_cast<float*>(image.localpixels());
    for (const V3f& n : directions.texels) {
        *dst++ = (n.x + 1) / 2;
        *dst++ = (green_is_up ? 1 + n.y : 1 - n.y) / 2;
        *dst++ = (n.z + 1) / 2;
    }
    return image;
}

} // namespace vmlight
