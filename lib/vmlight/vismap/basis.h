// SPDX-License-Identifier: Apache-2.0
/// What a visibility map can hold of a texel beside V and B, for models that know more of which part of the sky is
/// seen.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/math/harmonics.h>
#include <vmlight/math/packed_visibility.h>
#include <vmlight/math/ray_fan.h>
#include <vmlight/vismap/vismap.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Names of the channels that `params.basis` adds; none for `vector`.
std::vector<std::string> basis_channels(const VismapParams& params);
/// Whether these are linear in what is seen, so that means of them mean something.
bool is_linear_basis(const VismapParams& params);

/// Turns the rays of a texel into those numbers. One to a thread.
class VisibilityBasis
{
public:
    explicit VisibilityBasis(const VismapParams& params);

    int count() const { return m_count; }

    /// Set `dst` to count() numbers.
    ///
    /// @param fan          rays around `normal`, with the density of the cosine; lane bits where nothing blocks them
    /// @param asked        lane bits of those that lie above the surface
    /// @param surface      the geometric normal
    /// @param whole        whether all of the fan's rays do
    /// @param visibility   the share of them that nothing blocks
    void project(const RayFan& fan, const std::vector<uint8_t>& asked, bool whole, const Imath::V3f& normal,
                 const Imath::V3f& surface, double visibility, float* dst);

private:
    void project_harmonics(const RayFan& fan, const std::vector<uint8_t>& asked, bool whole, const Imath::V3f& normal,
                           double visibility, float* dst);

    const std::string m_basis;
    int m_count = 0;
    std::unique_ptr<Harmonics> m_harmonics;
    std::vector<float> m_values, m_seen_lanes, m_all_lanes;
    std::vector<double> m_seen, m_all;
    std::unique_ptr<VisibilityGrid> m_grid;
};

} // namespace vmlight
