// SPDX-License-Identifier: Apache-2.0
#include <vmlight/margin.h>

#include <algorithm>
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

} // namespace

Coverage::Coverage(int width, int height)
    : m_width(width)
    , m_height(height)
    , m_words_across(size_t(width + 63) / 64)
    , m_words(m_words_across * size_t(height))
{
}

void fill_margin(float* pixels, int channels, Coverage& coverage, int rings)
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
        for (const Texel& t : next) {
            double sum[4] = {};
            int count = 0;
            each_neighbour(coverage, t, [&](const Texel& n) {
                if (!coverage.get(n.x, n.y))
                    return;
                const float* neighbour = pixels + (size_t(n.y) * size_t(coverage.width()) + size_t(n.x)) * channels;
                for (int c = 0; c < 4; ++c)
                    sum[c] += double(neighbour[c]);
                ++count;
            });
            float* texel = pixels + (size_t(t.y) * size_t(coverage.width()) + size_t(t.x)) * channels;
            for (int c = 0; c < 4; ++c)
                texel[c] = float(sum[c] / count);
        }
        // Only now, so that a ring does not depend on the order within it.
        for (const Texel& t : next)
            coverage.set(t.x, t.y);
        front.swap(next);
    }
}

} // namespace vmlight
