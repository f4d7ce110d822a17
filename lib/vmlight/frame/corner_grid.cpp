// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/corner_grid.h>

#include <vmlight/math/ray_fan.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

using Imath::V2d;

// Lookups reach half a pixel: neighbouring corners touch.
constexpr double kReach = 0.5;
// How far a neighbour's uv may be from where it is expected, in steps from corner to corner.
constexpr double kBend = 0.3;

bool is_opaque(const FrameSample& sample)
{
    return sample.first.surface && sample.first.alpha == 1 && !sample.first.surface->catches_shadows;
}

// Whether b, one step along `change` from a, is where a expects it, and the other way round.
bool goes_on(const FrameSample& a, const FrameSample& b, V2d TextureFootprint::*change)
{
    if (!is_opaque(a) || !is_opaque(b) || a.first.surface != b.first.surface)
        return false;
    const TextureFootprint &from = a.first.uv, &to = b.first.uv;
    const V2d step = to.st - from.st;
    const V2d expected = from.*change / kReach, back = to.*change / kReach;
    const double longest = std::max({ expected.length(), back.length(), step.length() });
    // Not-a-number is not smooth.
    return (step - expected).length() <= kBend * longest && (step - back).length() <= kBend * longest;
}

} // namespace

std::array<double, CornerGrid::kAround> CornerGrid::weights(double variance)
{
    // w and 1/2 - w at 3/2 and 1/2 pixels to either side: 2 (w 9/4 + (1/2 - w) 1/4) = 1/4 + 4 w.
    const double w = (variance - 0.25) / 4;
    return { w, 0.5 - w, 0.5 - w, w };
}

bool CornerGrid::fill(const SampleShader& shader, const Camera& camera, const Size& picture, int left, int top,
                      int width, int height, std::string& error)
{
    m_left = left;
    m_top = top;
    m_columns = width + kAround - 1;
    const int rows = height + kAround - 1;
    m_samples.resize(size_t(m_columns) * size_t(rows));
    std::array<CameraRay, kPacketSize> rays;
    for (size_t first = 0; first < m_samples.size(); first += kPacketSize) {
        const int count = int(std::min(m_samples.size() - first, size_t(kPacketSize)));
        for (int i = 0; i < count; ++i) {
            const int column = int((first + size_t(i)) % size_t(m_columns)),
                      row = int((first + size_t(i)) / size_t(m_columns));
            rays[i] = camera.ray(left - 1 + column, top - 1 + row, picture.width, picture.height);
            rays[i].scale_differentials(kReach);
        }
        if (!shader.shade(&m_samples[first], rays.data(), count, error))
            return false;
    }
    m_to_right.assign(m_samples.size(), false);
    m_to_below.assign(m_samples.size(), false);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < m_columns; ++column) {
            const FrameSample& here = m_samples[index(column, row)];
            if (column + 1 < m_columns)
                m_to_right[index(column, row)]
                    = goes_on(here, m_samples[index(column + 1, row)], &TextureFootprint::dx);
            if (row + 1 < rows)
                m_to_below[index(column, row)]
                    = goes_on(here, m_samples[index(column, row + 1)], &TextureFootprint::dy);
        }
    return true;
}

bool CornerGrid::is_smooth(int x, int y) const
{
    for (int j = 0; j < kAround; ++j)
        for (int i = 0; i < kAround; ++i) {
            const size_t at = index(x - m_left + i, y - m_top + j);
            if ((i + 1 < kAround && !m_to_right[at]) || (j + 1 < kAround && !m_to_below[at]))
                return false;
        }
    return true;
}

} // namespace vmlight
