// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/sun_search.h>

#include <vmlight/math/latlong.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vmlight {
namespace {

using Imath::V3d;
using latlong::pi;

constexpr double kDegree = pi / 180;
/// Radii of cuts: the least is two texels of a map 512 wide, so that the light of a point stays inside.
constexpr double kLeastRadius = 1.5 * kDegree, kMostRadius = 12 * kDegree, kRadiusStep = 1.25;
/// Of the ring around a cut, whose median is the background.
constexpr double kRingWidth = 6 * kDegree;
/// A disc as wide as this gains nothing: models resolve about that much of the sky.
constexpr double kModelWidth = 10 * kDegree;
/// Of all light: a weaker sun is below the models' error on the rest.
constexpr double kLeastShare = 1.0 / 32;
/// A cut ends where the light rises again by this factor: another source begins.
constexpr double kRise = 1.5;

struct Texel
{
    double angle; // from the candidate
    size_t index;
};

struct Candidate
{
    SunSplit::Cut cut;
    double gain = 0; // energy, less for wide discs
    V3d direction { 0 }; // of the first moment
};

class Search
{
public:
    explicit Search(const OIIO::ImageBuf& map)
        : m_width(map.spec().width)
        , m_height(map.spec().height)
        , m_rgb(size_t(3) * m_width * m_height)
        , m_least(std::max(kLeastRadius, 1.5 * pi / m_height))
    {
        map.get_pixels(OIIO::ROI(0, m_width, 0, m_height, 0, 1, 0, 3), OIIO::TypeFloat, m_rgb.data());
        for (int j = 0; j < m_height; ++j)
            m_area.push_back(latlong::row_solid_angle(j, m_height) / m_width);
        for (int j = 0; j < m_height; ++j)
            for (int i = 0; i < m_width; ++i) {
                m_direction.push_back(latlong::direction((i + 0.5) / m_width, (j + 0.5) / m_height));
                m_all += light(m_direction.size() - 1) * m_area[size_t(j)];
            }
    }

    std::vector<SunSplit::Cut> run()
    {
        std::vector<SunSplit::Cut> cuts;
        while (cuts.size() < SunSplit::kMostSuns && m_least < kMostRadius && m_all > 0) {
            Candidate best;
            for (const V3d& seed : seeds()) {
                const Candidate found = settle(seed);
                if (found.gain > best.gain)
                    best = found;
            }
            if (best.gain < kLeastShare * m_all)
                break;
            set_background(best);
            apply(best);
            cuts.push_back(best.cut);
        }
        return cuts;
    }

private:
    double light(size_t texel) const
    {
        return (double(m_rgb[3 * texel]) + double(m_rgb[3 * texel + 1]) + double(m_rgb[3 * texel + 2])) / 3;
    }
    double area(size_t texel) const { return m_area[texel / size_t(m_width)]; }

    // The brightest places, at several sizes: a lamp may be dimmer than a glint, and yet a lamp.
    std::vector<V3d> seeds() const
    {
        constexpr int kEach = 4;
        std::vector<V3d> found;
        for (const int rows : { 128, 64, 32 }) {
            const int high = std::min(rows, m_height), wide = std::min(2 * high, m_width);
            std::vector<double> sum(size_t(high) * wide), weight(sum.size());
            std::vector<V3d> middle(sum.size(), V3d(0));
            for (size_t texel = 0; texel < m_direction.size(); ++texel) {
                const size_t row = texel / size_t(m_width) * size_t(high) / size_t(m_height);
                const size_t cell = row * wide + texel % size_t(m_width) * size_t(wide) / size_t(m_width);
                const double energy = light(texel) * area(texel);
                sum[cell] += energy;
                weight[cell] += area(texel);
                middle[cell] += m_direction[texel] * energy;
            }
            std::vector<size_t> order(sum.size());
            std::iota(order.begin(), order.end(), size_t(0));
            const auto mean = [&](size_t cell) { return sum[cell] / weight[cell]; };
            // More than enough to find kEach apart: a cell has fewer than 32 near ones.
            const size_t kept = std::min(order.size(), size_t(64 * kEach));
            std::partial_sort(order.begin(), order.begin() + ptrdiff_t(kept), order.end(),
                              [&](size_t a, size_t b) { return mean(a) > mean(b) || (mean(a) == mean(b) && a < b); });
            const double apart = std::cos(2 * pi / high);
            const size_t before = found.size();
            for (size_t k = 0; k < kept && found.size() < before + kEach; ++k) {
                if (!(sum[order[k]] > 0))
                    break;
                const V3d direction = middle[order[k]].normalized();
                const auto is_near = [&](const V3d& other) { return other.dot(direction) > apart; };
                if (std::none_of(found.begin(), found.end(), is_near))
                    found.push_back(direction);
            }
        }
        return found;
    }

    // The texels within `reach`, the nearest first.
    std::vector<Texel> around(const V3d& centre, double reach) const
    {
        std::vector<Texel> near;
        const double cosine = std::cos(reach), polar = std::acos(std::clamp(centre.y, -1.0, 1.0));
        const int first = std::max(0, int((polar - reach) / pi * m_height) - 1);
        const int end = std::min(m_height, int((polar + reach) / pi * m_height) + 2);
        for (size_t texel = size_t(first) * m_width; texel < size_t(end) * m_width; ++texel)
            if (m_direction[texel].dot(centre) >= cosine)
                near.push_back({ 2 * std::asin(std::min(1.0, 0.5 * (m_direction[texel] - centre).length())), texel });
        std::sort(near.begin(), near.end(), [](const Texel& a, const Texel& b) {
            return a.angle < b.angle || (a.angle == b.angle && a.index < b.index);
        });
        return near;
    }

    // Move a seed to the middle of its light.
    Candidate settle(const V3d& seed) const
    {
        constexpr int kSteps = 10;
        constexpr double kStill = 1e-9; // 1 - the cosine of .0025 degrees
        Candidate found;
        V3d centre = seed;
        for (int step = 0; step < kSteps; ++step) {
            found = grow(centre);
            if (!(found.gain > 0) || found.direction.dot(centre) > 1 - kStill)
                break;
            centre = found.direction;
        }
        return found;
    }

    // The cap around `centre` that gains most.
    Candidate grow(const V3d& centre) const
    {
        const std::vector<Texel> near = around(centre, kMostRadius + kRingWidth);
        const double end = std::clamp(end_of_light(near), m_least, kMostRadius);
        Candidate best;
        double low = m_least, high = m_least;
        for (double radius = m_least; radius <= end; radius *= kRadiusStep)
            if (const Candidate found = cap(near, centre, radius); found.gain > best.gain) {
                best = found;
                low = std::max(m_least, radius / kRadiusStep);
                high = std::min(end, radius * kRadiusStep);
            }
        // Between steps, by golden sections, so that the radius does not jump where the map changes a little.
        const double golden = 0.5 * (std::sqrt(5.0) - 1);
        for (int step = 0; step < 12 && best.gain > 0; ++step) {
            const double inner = high - golden * (high - low), outer = low + golden * (high - low);
            const Candidate a = cap(near, centre, inner), b = cap(near, centre, outer);
            (a.gain > b.gain ? high : low) = a.gain > b.gain ? outer : inner;
            for (const Candidate& found : { a, b })
                if (found.gain > best.gain)
                    best = found;
        }
        return best;
    }

    Candidate cap(const std::vector<Texel>& near, const V3d& centre, double radius) const
    {
        const SunSplit::Cut cut { centre, radius, {} };
        const double background = ring_median(near, radius, [&](size_t texel) { return light(texel); });
        double energy = 0;
        V3d moment(0);
        for (const Texel& texel : near) {
            const double share = cut.share(m_direction[texel.index], pi / m_height);
            if (share == 0 && texel.angle > radius)
                break;
            const double excess = share * std::max(0.0, light(texel.index) - background) * area(texel.index);
            energy += excess;
            moment += m_direction[texel.index] * excess;
        }
        if (!(energy > 0))
            return {};
        const double width = disc_half_angle(moment.length() / energy);
        return { cut, energy * (1 - width / kModelWidth), moment.normalized() };
    }

    // Where rings of texels become brighter again.
    double end_of_light(const std::vector<Texel>& near) const
    {
        const double step = std::max(0.5 * m_least, pi / m_height);
        double least = INFINITY, sum = 0, weight = 0, edge = m_least;
        for (const Texel& texel : near) {
            while (texel.angle > edge) {
                if (weight > 0 && sum / weight > kRise * least)
                    return edge - step;
                if (weight > 0)
                    least = std::min(least, sum / weight);
                sum = weight = 0;
                edge += step;
            }
            sum += light(texel.index) * area(texel.index);
            weight += area(texel.index);
        }
        return kMostRadius;
    }

    template <class Value> double ring_median(const std::vector<Texel>& near, double radius, Value&& value) const
    {
        std::vector<std::pair<double, double>> ring; // value, weight
        double all = 0;
        for (const Texel& texel : near)
            if (texel.angle > radius && texel.angle <= radius + std::min(radius + m_least, kRingWidth)) {
                ring.emplace_back(value(texel.index), area(texel.index));
                all += area(texel.index);
            }
        std::sort(ring.begin(), ring.end());
        double sum = 0;
        for (const auto& [level, weight] : ring)
            if ((sum += weight) >= 0.5 * all)
                return level;
        return 0;
    }

    void set_background(Candidate& found) const
    {
        const std::vector<Texel> near = around(found.cut.centre, kMostRadius + kRingWidth);
        for (size_t c = 0; c < 3; ++c)
            found.cut.background[c] = float(
                ring_median(near, found.cut.radius, [&](size_t texel) { return double(m_rgb[3 * texel + c]); }));
    }

    void apply(const Candidate& found)
    {
        for (const Texel& texel : around(found.cut.centre, found.cut.radius + pi / m_height))
            found.cut.apply(&m_rgb[3 * texel.index], m_direction[texel.index], pi / m_height);
    }

    const int m_width, m_height;
    std::vector<float> m_rgb;
    const double m_least;
    std::vector<double> m_area; // of a texel of each row
    std::vector<V3d> m_direction;
    double m_all = 0;
};

} // namespace

std::vector<SunSplit::Cut> search_suns(const OIIO::ImageBuf& map)
{
    return Search(map).run();
}

} // namespace vmlight
