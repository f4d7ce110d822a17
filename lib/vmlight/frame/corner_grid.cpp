// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/corner_grid.h>

#include <vmlight/math/ray_fan.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

using Imath::V2d;
using Imath::V3d;

// Lookups reach half a pixel: neighbouring corners touch.
constexpr double kReach = 0.5;
// How far a neighbour's uv may be from where it is expected, in steps from corner to corner.
constexpr double kBend = 0.3;
// How much the colours on both sides of a seam may differ, relative to their mean, and how many times as far apart the
// points may be as the surface says on either side. Measured on a scan of 40,000 triangles, RMS in per cent of the mean
// light and seconds a frame: .05 makes .33 and .36 of it, .1 .37 and .30, .2 .41 and .27; without, .29 and .45.
constexpr float kAlike = 0.1f;
constexpr double kGap = 4;

bool is_opaque(const FrameSample& sample)
{
    return sample.first.surface && sample.first.alpha == 1 && !sample.first.surface->catches_shadows;
}

// An axis of the picture: how texture coordinates and places change along it.
struct Axis
{
    V2d TextureFootprint::*uv;
    std::array<double, 3> FramePoint::*weight;
};
constexpr Axis kAcross { &TextureFootprint::dx, &FramePoint::weight_dx };
constexpr Axis kDown { &TextureFootprint::dy, &FramePoint::weight_dy };

// Whether a step is what both of its ends expect. Not-a-number is not.
template <class V> bool is_straight(const V& step, const V& expected, const V& back)
{
    const double longest = std::max({ expected.length(), back.length(), step.length() });
    return (step - expected).length() <= kBend * longest && (step - back).length() <= kBend * longest;
}

bool has_straight_uv(const SeenPoint& a, const SeenPoint& b, const Axis& axis)
{
    return is_straight(b.uv.st - a.uv.st, a.uv.*axis.uv / kReach, b.uv.*axis.uv / kReach);
}

// The length of a step from corner to corner on the plane of the triangle.
double step_length(const SeenPoint& seen, const Axis& axis)
{
    const auto& corners = seen.surface->mesh->triangles[seen.triangle];
    V3d step(0);
    for (int k = 0; k < 3; ++k)
        step += seen.surface->mesh->positions[corners[k]] * (seen.point.*axis.weight)[k];
    return step.length() / kReach;
}

bool is_beside(const SeenPoint& a, const SeenPoint& b, const Axis& axis)
{
    const double longest = std::max(step_length(a, axis), step_length(b, axis));
    return (b.point.position - a.point.position).length() <= kGap * longest;
}

bool is_alike(const Imath::C3f& a, const Imath::C3f& b)
{
    for (int c = 0; c < 3; ++c)
        if (!(std::abs(a[c] - b[c]) <= kAlike * (std::abs(a[c]) + std::abs(b[c])) / 2))
            return false;
    return true;
}

} // namespace

std::array<double, CornerGrid::kAround> CornerGrid::weights(double variance)
{
    // w and 1/2 - w at 3/2 and 1/2 pixels to either side: 2 (w 9/4 + (1/2 - w) 1/4) = 1/4 + 4 w.
    const double w = (variance - 0.25) / 4;
    return { w, 0.5 - w, 0.5 - w, w };
}

bool CornerGrid::fill(const SampleShader& shader, const Camera& camera, const Size& picture, int left, int top,
                      int width, int height, bool only_color, std::string& error)
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
            const auto goes_on = [&](const FrameSample& a, const FrameSample& b, const Axis& axis) {
                return is_opaque(a) && is_opaque(b) && a.first.surface == b.first.surface && !a.first.surface->strands
                    && (has_straight_uv(a.first, b.first, axis)
                        || (only_color && is_alike(a.color, b.color) && is_beside(a.first, b.first, axis)));
            };
            const FrameSample& here = m_samples[index(column, row)];
            if (column + 1 < m_columns)
                m_to_right[index(column, row)] = goes_on(here, m_samples[index(column + 1, row)], kAcross);
            if (row + 1 < rows)
                m_to_below[index(column, row)] = goes_on(here, m_samples[index(column, row + 1)], kDown);
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
