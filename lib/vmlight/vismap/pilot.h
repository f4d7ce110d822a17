// SPDX-License-Identifier: Apache-2.0
/// A sample of the texels of a visibility map, baked twice to estimate its error before the bake.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/ground_plane.h>
#include <vmlight/trace/surface.h>
#include <vmlight/uv/raster.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/open_triangles.h>
#include <vmlight/vismap/visibility_integrator.h>
#include <vmlight/vismap/vismap.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vmlight {

/// The error at one number of rays.
struct PilotError
{
    int samples = 0;
    /// Of V: see VismapPilot::measure().
    double rms = 0;
    /// Root mean square of Visibility::error; 0 unless the channel is asked for.
    double scatter_rms = 0;
    /// What makes the mean of pattern_variance() over the texels that of V's squared error; 0 if all agree.
    double pattern = 0;
    /// Time of the measurement.
    double seconds = 0;
};

/// The largest standard error of V that patterns of `measured.samples` rays leave, as pattern_variance() takes it:
/// measured, and where few texels were, near what is usual. A larger one would average what differs.
double pattern_error(const PilotError& measured, int64_t texels);

class VismapPilot
{
public:
    /// Texels to pick, or all if fewer are covered.
    static constexpr int64_t kTexels = 4096;

    /// @param scene    must outlive this, and so must the normal map, if not nullptr
    /// @param progress called with 0, since the bake is yet to come; returning false stops the work
    VismapPilot(const BakeScene& scene, const NormalMap* normal_map, const VismapParams& params, int nthreads,
                const Progress& progress);

    /// Pick covered texels evenly over the map, at most `most` and one of `least_step`. A function of coverage alone.
    /// False if stopped.
    /// @param neighbours   so many that follow each other, by tile and row, are picked together
    bool pick(const UvRaster& raster, const OpenTriangles& open, int64_t most = kTexels, int64_t least_step = 1,
              int64_t neighbours = 1);

    // After pick().
    /// Covered texels of the whole map, and picked ones.
    int64_t covered() const { return m_covered; }
    int64_t texels() const { return int64_t(m_texels.size()); }
    /// Of a picked texel in the map.
    Imath::V2i place(int64_t i) const { return { m_texels[size_t(i)].x, m_texels[size_t(i)].y }; }

    /// Bake the texels twice, with two seeds other than the map's: the root mean square of the difference over sqrt(2)
    /// estimates the root mean square standard error for any sampler, and its square is unbiased. The same bits for
    /// every number of threads, except the seconds. False if stopped.
    ///
    /// @param with_basis also compute the channels of the basis, so that the seconds are those of the bake
    bool measure(int samples, PilotError& dst, bool with_basis = false) const;

    /// Bake the texels once: V of each. False if stopped.
    bool visibility(int samples, std::vector<double>& dst) const;

private:
    bool bake(std::vector<std::array<Visibility, 2>>& seen, int samples, int times, bool with_basis) const;

    struct Texel
    {
        SurfacePoint point;
        int x, y;
        bool open;
    };
    const BakeScene& m_scene;
    const NormalMap* m_normal_map;
    const VismapParams m_params;
    const GroundPlane m_ground;
    const int m_threads;
    const Progress m_progress;
    int64_t m_covered = 0;
    std::vector<Texel> m_texels;
};

} // namespace vmlight
