// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/margin.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace vmlight {
namespace {

struct Texel
{
    int x, y;
};

template <class Visit> void each_neighbour(const Coverage& coverage, const Texel& t, Visit&& visit)
{
    for (int y = std::max(0, t.y - 1); y <= std::min(coverage.height() - 1, t.y + 1); ++y)
        for (int x = std::max(0, t.x - 1); x <= std::min(coverage.width() - 1, t.x + 1); ++x)
            if (x != t.x || y != t.y)
                visit(Texel { x, y });
}

// Covered texels with a neighbour that is not.
std::vector<Texel> rim(const Coverage& coverage)
{
    std::vector<Texel> texels;
    for (int y = 0; y < coverage.height(); ++y)
        for (int x = 0; x < coverage.width(); ++x) {
            if (x % 64 == 0 && coverage.word(x, y) == 0) {
                x += 63;
                continue;
            }
            bool has_gap = false;
            if (coverage.get(x, y))
                each_neighbour(coverage, { x, y }, [&](const Texel& n) { has_gap |= !coverage.get(n.x, n.y); });
            if (has_gap)
                texels.push_back({ x, y });
        }
    return texels;
}

double dot(const float* a, const float* b)
{
    return double(a[1]) * b[1] + double(a[2]) * b[2] + double(a[3]) * b[3];
}

void average_neighbours(float* pixels, int channels, const MarginChannels& which, const Coverage& coverage,
                        const Texel& t)
{
    const auto at = [&](const Texel& n) {
        return pixels + (size_t(n.y) * size_t(coverage.width()) + size_t(n.x)) * size_t(channels);
    };
    std::array<const float*, 8> filled {};
    int count = 0;
    each_neighbour(coverage, t, [&](const Texel& n) {
        if (coverage.get(n.x, n.y))
            filled[count++] = at(n);
    });
    // Where the margins of two islands meet, the mean of their directions is neither's, and would be lit from anywhere.
    // Neighbours that look elsewhere than the most decided one are left out. How far that is was measured on three
    // meshes, two skies, eight rotations: 30 degrees leave 60 texels lit as nothing around them is, 45 leave 234 and a
    // hairline to be seen, 90 leave 2009. The light of mip level 1 is 6 % farther from the truth than with 90, 11 % on
    // a coarse map; of higher levels 4 %.
    const float* leader = *std::max_element(filled.begin(), filled.begin() + count,
                                            [](const float* a, const float* b) { return dot(a, a) < dot(b, b); });
    const auto looks_elsewhere = [leader](const float* texel) {
        const double product = dot(texel, leader);
        return product < 0 || 4 * product * product < 3 * dot(texel, texel) * dot(leader, leader);
    };
    const auto end = std::remove_if(filled.begin(), filled.begin() + count, looks_elsewhere);
    std::copy_n(leader + which.averaged, which.copied, at(t) + which.averaged);
    for (int c = 0; c < which.averaged; ++c) {
        double sum = 0;
        for (auto texel = filled.begin(); texel != end; ++texel)
            sum += double((*texel)[c]);
        at(t)[c] = float(sum / double(end - filled.begin()));
    }
}

} // namespace

Coverage::Coverage(int width, int height)
    : m_width(width)
    , m_height(height)
    , m_words_across(size_t(width + 63) / 64)
    , m_words(m_words_across * size_t(height))
{
}

void fill_margin(float* pixels, int channels, Coverage& coverage, int rings, const MarginChannels& filled)
{
    std::vector<Texel> front = rim(coverage), next;
    Coverage queued = coverage;
    for (int ring = 0; ring != rings && !front.empty(); ++ring) {
        next.clear();
        for (const Texel& t : front)
            each_neighbour(coverage, t, [&](const Texel& n) {
                if (!queued.get(n.x, n.y)) {
                    queued.set(n.x, n.y);
                    next.push_back(n);
                }
            });
        for (const Texel& t : next)
            average_neighbours(pixels, channels, filled, coverage, t);
        // Only now, so that a ring does not depend on the order within it.
        for (const Texel& t : next)
            coverage.set(t.x, t.y);
        front.swap(next);
    }
}

} // namespace vmlight
