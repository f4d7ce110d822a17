// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/sun_visibility.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/math/sampling.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

bool parse_sun_directions(std::vector<Disc>& dst, const std::string& text, std::string& error)
{
    constexpr double kSunHalfAngle = 0.265, kDegree = latlong::pi / 180; // of the sun seen from the earth
    std::vector<Disc> discs;
    for (const std::string& part : OIIO::Strutil::splits(OIIO::Strutil::strip(text), ";")) {
        const std::vector<std::string> words = OIIO::Strutil::splits(part, ",");
        std::vector<double> numbers;
        for (const std::string& word : words)
            if (OIIO::Strutil::string_is_float(word))
                numbers.push_back(OIIO::Strutil::stod(word));
        const bool has_angle = numbers.size() == 4;
        const V3d direction = numbers.size() < 3 ? V3d(0) : V3d(numbers[0], numbers[1], numbers[2]);
        const bool good = words.size() == numbers.size() && (has_angle || numbers.size() == 3)
            && std::isfinite(direction.length()) && direction.length() > 0
            && (!has_angle || (numbers[3] >= 0 && numbers[3] <= 90));
        if (!good) {
            error = format(
                "sun_directions: \"{}\" is not a sun; each is x,y,z or x,y,z,HALF_ANGLE, with a direction other "
                "than 0 and 0 to 90 degrees, and \";\" goes between them",
                part);
            return false;
        }
        discs.push_back({ direction.normalized(), (has_angle ? numbers[3] : kSunHalfAngle) * kDegree });
    }
    dst = std::move(discs);
    return true;
}

std::string sun_directions_text(OIIO::cspan<Disc> discs)
{
    std::string text;
    for (const Disc& disc : discs)
        text += format("{}{:.6g},{:.6g},{:.6g},{:.4g}", text.empty() ? "" : ";", disc.direction.x, disc.direction.y,
                       disc.direction.z, disc.half_angle * 180 / latlong::pi);
    return text;
}

std::vector<std::string> sun_channels(const std::string& text)
{
    std::vector<Disc> discs;
    std::string ignored;
    parse_sun_directions(discs, text, ignored);
    return numbered_channels("sun", 0, int(discs.size()));
}

namespace {

// In a penumbra.
constexpr int kLeastRays = 16, kMostRays = 32;
// In half degrees. SunSplit parts light that is wider in four discs, whose errors even out.
constexpr double kWidest = 12;
// The first ones: if they all agree, the texel is not in the penumbra. Of a narrow disc six at the rim, where straight
// edges come in, and two inside: an edge that none of them sees cuts off less than 8 % of the disc.
constexpr int kProbes = 16, kFewProbes = 8;
constexpr int kFewOrder[kFewProbes] = { 1, 3, 5, 7, 9, 11, 0, 8 };

} // namespace

int disc_rays(double half_angle)
{
    // As many as half degrees fit in the disc, side by side.
    const double half_degrees = half_angle * 360 / latlong::pi;
    if (half_degrees > kWidest)
        return kLeastRays;
    int rays = kLeastRays;
    while (rays < kMostRays && rays < half_degrees * half_degrees)
        rays *= 2;
    return rays;
}

DiscTracer::DiscTracer(const Occluder& occluder, const Disc& disc, const DiscSamples& samples, int rays, float length,
                       int seed, const GroundPlane& ground, bool tries_blockers)
    : m_occluder(occluder)
    , m_samples(samples)
    , m_horizon(disc, ground)
    , m_mean_length(disc_mean_length(disc.half_angle))
    , m_rays_each(rays)
    , m_length(length)
    , m_seed(uint32_t(seed))
    , m_tries_blockers(tries_blockers)
{
    m_texels.reserve(kPacketSize + 1);
}

bool DiscTracer::place(Texel& dst, const SurfacePoint& point, int x, int y) const
{
    const DiscHeight height = m_horizon.height(point);
    if (height == DiscHeight::below)
        return false;
    const bool is_whole = height == DiscHeight::whole;
    const double facing = V3d(point.normal).dot(m_horizon.direction);
    const double scale = (is_whole ? facing * m_mean_length : 1.0 / m_rays_each) / DiscHorizon::counted(point);
    const uint32_t hash = texel_hash(uint32_t(x), uint32_t(y), m_seed).u;
    dst = { dst.dst, point, hash, scale, dst.is_open, is_whole, is_whole, m_horizon.ground.lowest_ray(point), 0, 0, 0 };
    return true;
}

void DiscTracer::add(const SurfacePoint& point, bool is_open, int x, int y, float* dst)
{
    *dst = 0;
    Texel texel {};
    texel.dst = dst;
    texel.is_open = is_open;
    if (place(texel, point, x, y))
        start(texel, !texel.is_probe ? m_rays_each : m_rays_each > kLeastRays ? kProbes : kFewProbes);
}

void DiscTracer::start(const Texel& texel, int rays)
{
    m_texels.push_back(texel);
    m_texels.back().rays_left = rays;
    for (int ray = 0; ray < rays; ++ray) {
        Texel& own = m_texels.back();
        const V3f& direction = own.is_probe ? m_samples.probe(own.hash, rays == kFewProbes ? kFewOrder[ray] : ray)
                                            : m_samples.at(own.hash, ray, rays);
        const double cosine = double(direction.dot(own.point.normal));
        if (!(cosine > 0 && direction.dot(own.point.geometric_normal) > 0 && direction.y >= own.lowest)) {
            if (--own.rays_left == 0)
                finish(own);
            continue;
        }
        own.all += cosine;
        if (own.is_open || m_blockers.surely_block(own.point.origin, direction, m_length)) {
            own.seen += own.is_open ? cosine : 0;
            if (--own.rays_left == 0)
                finish(own);
            continue;
        }
        m_is_near = m_is_near || own.point.is_near;
        m_origins[size_t(m_count)] = own.point.origin;
        m_directions[size_t(m_count)] = direction;
        m_cosines[size_t(m_count)] = cosine;
        m_owner[size_t(m_count)] = m_texels.size() - 1;
        if (++m_count == kPacketSize)
            trace();
    }
    if (m_texels.back().rays_left == 0)
        m_texels.pop_back();
}

void DiscTracer::flush()
{
    if (m_count > 0)
        trace();
    std::vector<Texel> again;
    again.swap(m_again);
    for (Texel& texel : again) {
        texel.is_probe = false;
        texel.all = texel.seen = 0;
        start(texel, m_rays_each);
    }
    if (m_count > 0)
        trace();
    m_texels.clear();
}

void DiscTracer::trace()
{
    for (int i = m_count; i < kPacketSize; ++i) { // unused lanes must hold valid numbers too
        m_origins[size_t(i)] = m_origins[0];
        m_directions[size_t(i)] = m_directions[0];
    }
    Blocker blocker;
    const bool tries = m_tries_blockers && m_blockers.pay();
    const uint8_t blocked = m_occluder.find_blocked(m_origins.data(), m_directions.data(), m_count, m_length, m_is_near,
                                                    tries ? &blocker : nullptr);
    m_blockers.remember(blocker, tries && blocked != 0);
    for (int i = 0; i < m_count; ++i) {
        Texel& texel = m_texels[m_owner[size_t(i)]];
        texel.seen += blocked >> i & 1 ? 0 : m_cosines[size_t(i)];
        if (--texel.rays_left == 0)
            finish(texel);
    }
    m_rays += m_count;
    m_count = 0;
    m_is_near = false;
    // The last may have rays to come.
    std::swap(m_texels.front(), m_texels.back());
    m_texels.erase(m_texels.begin() + 1, m_texels.end());
}

void DiscTracer::finish(const Texel& texel)
{
    if (texel.is_probe && texel.seen > 0 && texel.seen < texel.all) {
        m_again.push_back(texel);
        return;
    }
    const double mean = !texel.is_whole ? texel.seen : texel.all > 0 ? texel.seen / texel.all : 0;
    *texel.dst = float(texel.scale * mean);
}

} // namespace vmlight
