// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/sun_cap.h>

#include <vmlight/math/latlong.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

using Imath::V3d;
using latlong::pi;

constexpr double kRadiusStep = 1.25;

// The least value that at least half of all weight is not above. Reorders `values`.
double weighted_median(std::vector<std::pair<float, float>>& values)
{
    double left = 0;
    for (const auto& [value, weight] : values)
        left += double(weight);
    left *= 0.5;
    auto begin = values.begin(), end = values.end();
    while (end - begin > 1) {
        const auto middle = begin + (end - begin) / 2;
        std::nth_element(begin, middle, end);
        double below = 0;
        for (auto it = begin; it != middle; ++it)
            below += double(it->second);
        if (below >= left) {
            end = middle;
        } else {
            left -= below;
            begin = middle;
        }
    }
    return begin == end ? 0 : double(begin->first);
}

std::vector<float> pixels_of(const OIIO::ImageBuf& map)
{
    const OIIO::ImageSpec& spec = map.spec();
    std::vector<float> rgb(size_t(3) * size_t(spec.width) * size_t(spec.height));
    map.get_pixels(OIIO::ROI(0, spec.width, 0, spec.height, 0, 1, 0, 3), OIIO::TypeFloat, rgb.data());
    return rgb;
}

} // namespace

SunMap::SunMap(int map_width, int map_height, std::vector<float> pixels, const SunScale& lights)
    : width(map_width)
    , height(map_height)
    , rgb(std::move(pixels))
    , scale(lights)
{
    scale.least_radius = std::max(scale.least_radius, 1.5 * pi / height);
    light.reserve(rgb.size() / 3);
    direction.reserve(rgb.size() / 3);
    std::vector<V3d> equator;
    for (int i = 0; i < width; ++i)
        equator.push_back(latlong::direction((i + 0.5) / width, 0.5));
    const float* pixel = rgb.data();
    for (int j = 0; j < height; ++j) {
        const double polar = (j + 0.5) / height * pi, sine = std::sin(polar), cosine = std::cos(polar);
        area.push_back(latlong::row_solid_angle(j, height) / width);
        double row = 0;
        for (int i = 0; i < width; ++i, pixel += 3) {
            direction.push_back({ equator[size_t(i)].x * sine, cosine, equator[size_t(i)].z * sine });
            light.push_back(float((double(pixel[0]) + double(pixel[1]) + double(pixel[2])) / 3));
            row += double(light.back());
        }
        all += row * area.back();
    }
}

SunMap::SunMap(const OIIO::ImageBuf& map, const SunScale& lights)
    : SunMap(map.spec().width, map.spec().height, pixels_of(map), lights)
{
}

SunMap SunMap::reduced(int factor, const SunScale& lights) const
{
    const int wide = width / factor, high = height / factor;
    std::vector<float> means;
    means.reserve(size_t(3) * size_t(wide) * size_t(high));
    for (int j = 0; j < high; ++j)
        for (int i = 0; i < wide; ++i) {
            std::array<double, 3> sum {};
            double weight = 0;
            for (int y = j * factor; y < (j + 1) * factor; ++y)
                for (int x = i * factor; x < (i + 1) * factor; ++x) {
                    const float* pixel = &rgb[3 * (size_t(y) * size_t(width) + size_t(x))];
                    for (size_t c = 0; c < 3; ++c)
                        sum[c] += area[size_t(y)] * double(pixel[c]);
                    weight += area[size_t(y)];
                }
            for (const double channel : sum)
                means.push_back(float(channel / weight));
        }
    return SunMap(wide, high, std::move(means), lights);
}

SunCap::SunCap(const SunMap& map, const V3d& centre)
    : m_map(map)
    , m_centre(centre)
{
    const double reach = map.scale.most_radius + map.scale.ring_width;
    // In the order of the map first, by rings a sixteenth of a texel wide.
    const double ring = map.height_of_texel() / 16, cosine = std::cos(reach);
    const size_t rings = size_t(reach / ring) + 2;
    std::vector<Texel> near;
    std::vector<uint32_t> start(rings + 1);
    const auto ring_of = [&](const Texel& texel) { return std::min(rings - 1, size_t(double(texel.angle) / ring)); };
    const Imath::V2d at = latlong::position(centre);
    const double polar = at.y * pi;
    const int first = std::max(0, int((polar - reach) / pi * map.height) - 1);
    const int end = std::min(map.height, int((polar + reach) / pi * map.height) + 2);
    for (int j = first; j < end; ++j) {
        const double row = (j + 0.5) / map.height * pi;
        // Of the longitude from the centre where the row leaves the cap.
        const double edge
            = (cosine - std::cos(row) * std::cos(polar)) / std::max(1e-9, std::sin(row) * std::sin(polar));
        const int half = edge <= -1 ? map.width : edge >= 1 ? 0 : int(std::acos(edge) / (2 * pi) * map.width) + 1;
        const int middle = int(at.x * map.width);
        const int left = 2 * half + 1 >= map.width ? 0 : middle - half;
        const int count = std::min(map.width, 2 * half + 1);
        for (int i = left; i < left + count; ++i) {
            const size_t index = size_t(j) * size_t(map.width) + size_t((i + map.width) % map.width);
            const V3d& direction = map.direction[index];
            if (direction.dot(centre) < cosine)
                continue;
            const double angle = 2 * std::asin(std::min(1.0, 0.5 * (direction - centre).length()));
            near.push_back({ float(angle), map.light[index], float(map.area[size_t(j)]), uint32_t(index) });
            ++start[ring_of(near.back()) + 1];
        }
    }
    for (size_t r = 0; r < rings; ++r)
        start[r + 1] += start[r];
    m_texels.resize(near.size());
    for (const Texel& texel : near)
        m_texels[start[ring_of(texel)]++] = texel;
    // A ring has few, and most are in order.
    const auto before
        = [](const Texel& a, const Texel& b) { return a.angle < b.angle || (a.angle == b.angle && a.index < b.index); };
    auto from = m_texels.begin();
    for (size_t r = 0; r < rings; ++r) {
        const auto to = m_texels.begin() + ptrdiff_t(start[r]);
        std::sort(from, to, before);
        from = to;
    }
}

SunCandidate SunCap::grow(bool between_steps) const
{
    const double least = m_map.scale.least_radius, end = std::clamp(end_of_light(), least, m_map.scale.most_radius);
    std::vector<Knot> knots;
    const auto add = [&](double radius) {
        knots.push_back({ radius, ring_median(radius, [](const Texel& texel) { return texel.light; }) });
    };
    for (double radius = least; radius < end; radius *= kRadiusStep)
        add(radius);
    add(end);
    SunCandidate best;
    size_t at = 0;
    for (size_t k = 0; k < knots.size(); ++k)
        if (const SunCandidate found = cap(knots[k].radius, knots[k].background); found.gain > best.gain) {
            best = found;
            at = k;
        }
    // By golden sections.
    const auto between = [&](double radius) {
        size_t k = 1;
        while (k + 1 < knots.size() && knots[k].radius < radius)
            ++k;
        const Knot &a = knots[k - 1], &b = knots[k];
        const double part = (radius - a.radius) / (b.radius - a.radius);
        const SunCandidate found = cap(radius, a.background + part * (b.background - a.background));
        if (found.gain > best.gain)
            best = found;
        return found.gain;
    };
    if (!between_steps || !(best.gain > 0) || knots.size() < 2)
        return best;
    constexpr int kSections = 12;
    const double golden = 0.5 * (std::sqrt(5.0) - 1);
    double low = knots[at > 0 ? at - 1 : 0].radius, high = knots[std::min(at + 1, knots.size() - 1)].radius;
    double inner = high - golden * (high - low), outer = low + golden * (high - low);
    double inner_gain = between(inner), outer_gain = between(outer);
    for (int step = 1; step < kSections; ++step) {
        if (inner_gain > outer_gain) {
            high = outer;
            outer = inner;
            outer_gain = inner_gain;
            inner = high - golden * (high - low);
            inner_gain = between(inner);
        } else {
            low = inner;
            inner = outer;
            inner_gain = outer_gain;
            outer = low + golden * (high - low);
            outer_gain = between(outer);
        }
    }
    return best;
}

SunCandidate SunCap::cap(double radius, double background) const
{
    const SunSplit::Cut cut { m_centre, radius, {} };
    double energy = 0;
    V3d moment(0);
    for (const Texel& texel : m_texels) {
        const double share = cut.share_at(double(texel.angle), m_map.height_of_texel());
        if (share == 0)
            break;
        const double excess = share * (double(texel.light) - background) * double(texel.area);
        if (excess <= 0)
            continue;
        energy += excess;
        moment += m_map.direction[texel.index] * excess;
    }
    if (!(energy > 0))
        return {};
    const double width = disc_half_angle(moment.length() / energy);
    return { cut, energy * (1 - width / m_map.scale.model_width), moment.normalized() };
}

// Where rings of texels become brighter again.
double SunCap::end_of_light() const
{
    const double step = std::max(0.5 * m_map.scale.least_radius, m_map.height_of_texel());
    double least = INFINITY, sum = 0, weight = 0, edge = m_map.scale.least_radius;
    for (const Texel& texel : m_texels) {
        while (double(texel.angle) > edge) {
            if (weight > 0 && sum / weight > m_map.scale.rise * least)
                return edge - step;
            if (weight > 0)
                least = std::min(least, sum / weight);
            sum = weight = 0;
            edge += step;
        }
        sum += double(texel.light) * double(texel.area);
        weight += double(texel.area);
    }
    return m_map.scale.most_radius;
}

std::vector<SunCap::Texel>::const_iterator SunCap::beyond(double angle) const
{
    return std::upper_bound(m_texels.begin(), m_texels.end(), angle,
                            [](double a, const Texel& texel) { return a < double(texel.angle); });
}

template <class Value> double SunCap::ring_median(double radius, Value&& value) const
{
    m_ring.clear();
    const auto end = beyond(radius + std::min(radius + m_map.scale.least_radius, m_map.scale.ring_width));
    for (auto texel = beyond(radius); texel < end; ++texel)
        m_ring.emplace_back(value(*texel), texel->area);
    return weighted_median(m_ring);
}

double SunCap::background(double radius, size_t channel) const
{
    return ring_median(radius, [&](const Texel& texel) { return m_map.rgb[3 * size_t(texel.index) + channel]; });
}

} // namespace vmlight
