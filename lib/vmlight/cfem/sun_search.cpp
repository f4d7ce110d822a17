// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/sun_search.h>

#include <vmlight/cfem/sun_cap.h>
#include <vmlight/math/latlong.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vmlight {
namespace {

using Imath::V3d;
using latlong::pi;

/// Of all light: a weaker sun is below the models' error on the rest.
constexpr double kLeastShare = 1.0 / 32;
/// A further one: of all light, and of the suns before it, beside which a weaker one's shadows hardly count.
constexpr double kLeastFurtherShare = 1.0 / 128, kLeastOfOthers = 1.0 / 16;
/// A seed that gains less than this part of it will not become a sun on its way.
constexpr double kHopeless = 0.125;
constexpr double kDegree = pi / 180;

/// Suns and lamps. The least cut is two texels of a map 512 wide, so that the light of a point stays inside.
constexpr SunScale kNarrow { 1.5 * kDegree,   12 * kDegree,  6 * kDegree,      10 * kDegree, 1.5,
                             { 128, 64, 32 }, 0.2 * kDegree, 0.0025 * kDegree, false };
/// The glow around a sun, a window, a softbox. Of light spread over 30 degrees, models still make two thirds of the
/// error that they make of a point's (docs/accuracy.md). Such light is lumpy: it does not end where it rises again.
constexpr SunScale kWide { 12 * kDegree,  30 * kDegree, 6 * kDegree,    60 * kDegree, 1e30,
                           { 32, 16, 8 }, 2 * kDegree,  0.05 * kDegree, true };

class Search
{
public:
    /// @param all  light of the whole environment
    Search(SunMap map, double all)
        : m_map(std::move(map))
        , m_all(all)
    {
    }

    const SunMap& map() const { return m_map; }

    /// Add cuts to those of earlier searches, which took `taken`.
    void run(std::vector<SunSplit::Cut>& cuts, double& taken)
    {
        while (cuts.size() < SunSplit::kMostSuns && m_map.scale.least_radius < m_map.scale.most_radius && m_all > 0) {
            SunCandidate best;
            for (const V3d& seed : seeds()) {
                const SunCandidate found = settled(seed);
                if (found.gain > best.gain)
                    best = found;
            }
            const double share = cuts.empty() || m_map.scale.is_wide ? kLeastShare : kLeastFurtherShare;
            const double least = std::max(share * m_all, kLeastOfOthers * taken);
            // What is looked at closely gains more, but not that much.
            if (best.gain < 0.75 * least)
                break;
            best = settle(best.direction, m_map.scale.still, true).found;
            if (best.gain < least)
                break;
            taken += best.gain;
            if (m_map.scale.is_wide)
                best.cut.middle = best.direction;
            cut_out(best.cut);
            cuts.push_back(best.cut);
        }
    }

private:
    // Where the light around a seed is. Another sun's cut, far away, does not change it.
    struct Settled
    {
        V3d seed;
        SunCandidate found;
        double reach; // from the seed, of texels that were read
    };

    // The brightest places, at several sizes: a lamp may be dimmer than a glint, and yet a lamp.
    std::vector<V3d> seeds() const
    {
        constexpr int kEach = 4;
        std::vector<V3d> found;
        for (const int rows : m_map.scale.seed_rows) {
            const int high = std::min(rows, m_map.height), wide = std::min(2 * high, m_map.width);
            std::vector<double> sum(size_t(high) * size_t(wide)), weight(sum.size());
            std::vector<V3d> middle(sum.size(), V3d(0));
            size_t texel = 0;
            for (int j = 0; j < m_map.height; ++j) {
                const size_t row = size_t(j) * size_t(high) / size_t(m_map.height);
                const double area = m_map.area[size_t(j)];
                for (int i = 0; i < m_map.width; ++i, ++texel) {
                    const size_t cell = row * size_t(wide) + size_t(i) * size_t(wide) / size_t(m_map.width);
                    const double energy = double(m_map.light[texel]) * area;
                    sum[cell] += energy;
                    weight[cell] += area;
                    middle[cell] += m_map.direction[texel] * energy;
                }
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

    SunCandidate settled(const V3d& seed)
    {
        for (const Settled& known : m_settled)
            if (known.seed == seed)
                return known.found;
        m_settled.push_back(settle(seed, m_map.scale.near, false));
        return m_settled.back().found;
    }

    // Move a seed to the middle of its light, until it moves by less than `still`. If it meets an earlier one on the
    // way, theirs is the same.
    Settled settle(const V3d& seed, double still, bool between_steps) const
    {
        constexpr int kSteps = 10;
        Settled result { seed, {}, 0 };
        V3d centre = seed;
        for (int step = 0; step < kSteps; ++step) {
            const SunCap cap(m_map, centre);
            result.found = cap.grow(between_steps);
            result.reach = std::max(result.reach, angle_between(seed, centre) + double(cap.texels().back().angle));
            if (result.found.gain < kHopeless * kLeastShare * m_all
                || angle_between(result.found.direction, centre) < still)
                break;
            centre = result.found.direction;
            if (between_steps)
                continue;
            for (const Settled& known : m_settled)
                if (angle_between(known.found.direction, centre) < m_map.scale.near) {
                    result.found = known.found;
                    result.reach = std::max(result.reach, angle_between(seed, known.seed) + known.reach);
                    return result;
                }
        }
        return result;
    }

    // Set the background of a cut and take its light from the map.
    void cut_out(SunSplit::Cut& cut)
    {
        const SunCap cap(m_map, cut.centre);
        for (size_t c = 0; c < 3; ++c)
            cut.background[c] = float(cap.background(cut.radius, c));
        const double reach = cut.radius + m_map.height_of_texel();
        for (const SunCap::Texel& texel : cap.texels()) {
            if (double(texel.angle) > reach)
                break;
            float* rgb = &m_map.rgb[3 * size_t(texel.index)];
            cut.apply(rgb, m_map.direction[texel.index], m_map.height_of_texel());
            m_map.light[texel.index] = float((double(rgb[0]) + double(rgb[1]) + double(rgb[2])) / 3);
        }
        const auto was_read
            = [&](const Settled& known) { return angle_between(known.seed, cut.centre) <= known.reach + reach; };
        m_settled.erase(std::remove_if(m_settled.begin(), m_settled.end(), was_read), m_settled.end());
    }

    static double angle_between(const V3d& a, const V3d& b)
    {
        return 2 * std::asin(std::min(1.0, 0.5 * (a - b).length()));
    }

    SunMap m_map;
    double m_all;
    std::vector<Settled> m_settled;
};

} // namespace

std::vector<SunSplit::Cut> search_suns(const OIIO::ImageBuf& map)
{
    std::vector<SunSplit::Cut> cuts;
    double taken = 0;
    const SunMap whole(map, kNarrow);
    Search narrow(whole, whole.all);
    narrow.run(cuts, taken);
    if (cuts.empty())
        return cuts;
    // Wide lights need no small texels.
    int factor = 4;
    while (whole.width % factor != 0 || whole.height % factor != 0)
        factor /= 2;
    Search(narrow.map().reduced(factor, kWide), whole.all).run(cuts, taken);
    return cuts;
}

} // namespace vmlight
