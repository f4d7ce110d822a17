// SPDX-License-Identifier: Apache-2.0
/// Some texels of a visibility map, baked twice: what its error is, before it is baked.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/surface.h>
#include <vmlight/uv/raster.h>
#include <vmlight/vismap/vismap.h>

#include <cstdint>
#include <vector>

namespace vmlight {

/// At one count of rays.
struct PilotError
{
    int samples = 0;
    /// Of V: see VismapPilot::measure().
    double rms = 0;
    /// Root mean square of Visibility::error; 0 unless the channel is asked for.
    double lane_rms = 0;
    /// What it took.
    double seconds = 0;
};

class VismapPilot
{
public:
    /// As many texels as this, or all if fewer are covered.
    static constexpr int64_t kTexels = 4096;

    /// @param scene    must outlive this
    /// @param progress told 0 while it works, since the bake is yet to come; false stops it
    VismapPilot(const BakeScene& scene, const VismapParams& params, int nthreads, const Progress& progress);

    /// Choose covered texels evenly over the map. A function of what is covered alone. False if stopped.
    bool pick(const UvRaster& raster);

    // After pick().
    /// Covered texels of the whole map, and of them those that were picked.
    int64_t covered() const { return m_covered; }
    int64_t texels() const { return int64_t(m_texels.size()); }

    /// Bake the texels twice, with two seeds of which neither is the map's: the root mean square of the difference over
    /// sqrt(2) is an estimate of the root mean square standard error, whatever the sampler, and its square is unbiased.
    /// Bit-equal for every number of threads, but for the seconds. False if stopped.
    ///
    /// @param with_basis make the channels of the basis too, which change the seconds alone: they are the bake's then
    bool measure(int samples, PilotError& dst, bool with_basis = false) const;

private:
    struct Texel
    {
        SurfacePoint point;
        int x, y;
    };
    const BakeScene& m_scene;
    const VismapParams m_params;
    const int m_threads;
    const Progress m_progress;
    int64_t m_covered = 0;
    std::vector<Texel> m_texels;
};

} // namespace vmlight
