// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/normal_map.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>

#include <OpenImageIO/hash.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

using Imath::V3d;
using Imath::V3f;
using OIIO::ImageBuf;

constexpr float kShortest = 0.7f, kLongest = 1.3f;
// Straight up is 127 in some programs and 128 in others.
constexpr float kFlat = 1.001f / 255;
constexpr double kNoDirection = 1e-6;
// Shares of pixels that are no directions.
constexpr double kWarned = 0.01, kRefused = 0.5;

// R, G and B by their names, else the first channels; without B, -1.
std::array<int, 3> channels_of(const OIIO::ImageSpec& spec)
{
    const int r = spec.channelindex("R"), g = spec.channelindex("G"), b = spec.channelindex("B");
    if (r >= 0 && g >= 0)
        return { r, g, b };
    return { 0, 1, spec.nchannels > 2 && spec.alpha_channel != 2 ? 2 : -1 };
}

// The image as directions, without a limit on their lengths.
bool read_directions(ImageBuf& dst, const ImageBuf& image, bool flips_green, int nthreads, std::string& error)
{
    const OIIO::ImageSpec& spec = image.spec();
    if (spec.nchannels < 2) {
        error = "one channel: a bump or height map; a normal map has R, G and B";
        return false;
    }
    const std::array<int, 3> channels = channels_of(spec);
    dst = OIIO::ImageBufAlgo::channels(image, 3, channels, {}, {}, false, nthreads);
    dst = OIIO::ImageBufAlgo::copy(dst, OIIO::TypeDesc::FLOAT, {}, nthreads);
    auto* pixels = static_cast<float*>(dst.localpixels());
    const size_t count = size_t(dst.spec().image_pixels()) * 3;
    bool is_signed = false;
    for (size_t i = 0; i < count; ++i) {
        if (!std::isfinite(pixels[i])) {
            error
                = format("pixel ({}, {}) is {}", (i / 3) % size_t(spec.width), (i / 3) / size_t(spec.width), pixels[i]);
            return false;
        }
        is_signed = is_signed || pixels[i] < 0;
    }
    for (size_t i = 0; i < count; i += 3) {
        float* n = pixels + i;
        for (int c = 0; c < 3 && !is_signed; ++c)
            n[c] = 2 * n[c] - 1;
        if (channels[2] < 0)
            n[2] = std::sqrt(std::max(0.0f, 1 - n[0] * n[0] - n[1] * n[1]));
        if (flips_green)
            n[1] = -n[1];
    }
    return true;
}

int64_t count_faulty(const ImageBuf& directions)
{
    const auto* n = static_cast<const V3f*>(directions.localpixels());
    return std::count_if(n, n + directions.spec().image_pixels(), [](const V3f& v) {
        const float length = v.length();
        return length < kShortest || length > kLongest;
    });
}

} // namespace

bool NormalMap::decode(const ImageBuf& image, const NormalMapParams& params, Size size, int nthreads,
                       std::vector<std::string>& warnings, std::string& error)
{
    ImageBuf directions;
    if (!read_directions(directions, image, params.normal_map_space == "tangent" && params.normal_map_green == "down",
                         nthreads, error))
        return false;
    const double share = double(count_faulty(directions)) / double(directions.spec().image_pixels());
    if (share > kRefused) {
        error = format("{:.0f} % of its pixels are not unit vectors: not a normal map", 100 * share);
        return false;
    }
    if (share > kWarned)
        warnings.push_back(format("{:.1f} % of its pixels are not unit vectors", 100 * share));
    m_is_object_space = params.normal_map_space == "object";
    if (directions.spec().width != size.width || directions.spec().height != size.height) {
        // Its own display window must not place it.
        directions.specmod().full_x = directions.specmod().full_y = directions.specmod().x = directions.specmod().y = 0;
        directions.specmod().full_width = directions.spec().width;
        directions.specmod().full_height = directions.spec().height;
        OIIO::ImageBuf resized;
        oiio::resize(resized, directions, OIIO::ROI(0, size.width, 0, size.height), nthreads);
        directions = std::move(resized);
    }
    m_width = size.width;
    const auto* first = static_cast<const V3f*>(directions.localpixels());
    m_normals.assign(first, first + directions.spec().image_pixels());
    settle();
    const auto below = std::count_if(m_normals.begin(), m_normals.end(), [](const V3f& n) { return n.z < 0; });
    m_points_inwards = !m_is_object_space && double(below) > kWarned * double(m_normals.size());
    if (m_points_inwards)
        warnings.push_back(
            format("{:.1f} % of its normals point into the surface", 100 * double(below) / double(m_normals.size())));
    return true;
}

void NormalMap::settle()
{
    m_is_flat = !m_is_object_space && std::all_of(m_normals.begin(), m_normals.end(), [](const V3f& n) {
        return std::abs(n.x) <= kFlat && std::abs(n.y) <= kFlat && n.z > 0;
    });
    if (m_is_flat)
        m_normals = {};
}

void NormalMap::scale(float lean)
{
    for (V3f& n : m_normals) {
        n.x *= lean;
        n.y *= lean;
    }
    settle();
}

void NormalMap::reset(Size size)
{
    m_is_flat = m_is_object_space = false;
    m_width = size.width;
    m_normals.assign(size_t(size.width) * size_t(size.height), V3f(0, 0, 1));
}

void NormalMap::take(const NormalMap& part, const std::vector<uint32_t>& chosen, uint32_t choice)
{
    for (size_t i = 0; i < part.m_normals.size(); ++i)
        if (chosen[i] == choice)
            m_normals[i] = part.m_normals[i];
}

void NormalMap::attach(std::shared_ptr<const Mesh> mesh)
{
    m_mesh = std::move(mesh);
    if (!m_is_flat && !m_is_object_space)
        m_tangents = make_tangents(*m_mesh);
}

bool NormalMap::is_same_image(const NormalMap& other) const
{
    return m_is_object_space == other.m_is_object_space && m_normals == other.m_normals;
}

uint64_t NormalMap::hash() const
{
    const std::array<uint64_t, 2> parts { uint64_t(m_is_object_space),
                                          OIIO::farmhash::Fingerprint64(reinterpret_cast<const char*>(m_normals.data()),
                                                                        m_normals.size() * sizeof(V3f)) };
    return OIIO::farmhash::Fingerprint64(reinterpret_cast<const char*>(parts.data()), sizeof(parts));
}

bool NormalMap::is_turned(const NormalMap& base, uint32_t triangle, const Rotation& turn, bool exactly) const
{
    constexpr double kRounding = 1e-5; // of tangents from positions in float
    for (size_t k = 0; k < 3 && !m_tangents.empty(); ++k) {
        const CornerTangent &before = base.m_tangents[triangle][k], &after = m_tangents[triangle][k];
        if (before.sign != after.sign || (exactly && before.tangent != after.tangent)
            || !((rotate(turn, V3d(before.tangent)) - V3d(after.tangent)).length() <= kRounding))
            return false;
    }
    return true;
}

void NormalMap::apply(SurfacePoint& point, uint32_t triangle, float weight1, float weight2, int x, int y) const
{
    if (m_is_flat)
        return;
    const V3d local(m_normals[size_t(y) * size_t(m_width) + size_t(x)]);
    V3d mapped = local;
    if (!m_is_object_space)
        mapped = tangent_space(*m_mesh, m_mesh->triangles[triangle], m_tangents[triangle], weight1, weight2)
                     .to_object(local);
    const double length = mapped.length();
    if (length > kNoDirection) // and a number
        point.normal = V3f(mapped / length);
}

} // namespace vmlight
