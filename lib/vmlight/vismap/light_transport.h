// SPDX-License-Identifier: Apache-2.0
/// Which surfaces light which texels of a map, and by how much: what light takes on its first bounce, whatever the
/// light.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/vismap/light_cells.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/transport_params.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/span.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

struct TransportTile;

/// Traced once for a map, then summed up for any light. Once prepared, any number of threads may gather at once.
class LightTransport
{
public:
    LightTransport();
    ~LightTransport();

    /// Trace the rays of all texels that something blocks the view of.
    ///
    /// @param scene    built, without leaving out occluders (SceneChoice::cull) that may shade others; all of it
    ///                 reflects light on both sides
    /// @param map      as for the visibility map of the same texels: size, UDIM tile, maximum distance, ground, margin,
    ///                 measure, sampler, samples and seed
    /// @param visibility   V of that map, one float a texel. Texels with V >= 1 trace no ray, and those of the measure
    ///                 `cosine` take 1 - V for what is blocked; where all of a texel's rays then miss what that is, the
    ///                 rays of the bake are traced again. Empty: all of it is found by rays
    /// @returns false, with the reason in `error`, if a parameter is out of range, the scene lacks occluders,
    ///          `visibility` is of another size, memory does not suffice, or `progress` stopped the work
    bool prepare(BakeScenePointer scene, const VismapParams& map, OIIO::cspan<float> visibility,
                 const TransportParams& params, std::string& error, int nthreads = 0, const Progress& progress = {},
                 NormalMapPointer normal_map = nullptr);

    /// After prepare(): points that light texels and have no texel themselves.
    const std::vector<LightPoint>& points() const { return m_points; }
    /// The points' surfaces, for bake_points().
    const std::vector<SurfacePoint>& surfaces() const { return m_surfaces; }

    /// Sum up what each texel gets: I = (1/pi) Int (1 - vis(w)) R(y) max(0, n.w) dw, where R(y) is what leaves the
    /// point y that a ray meets. Directions below the geometric surface are left out, and the rest divided by the share
    /// of the cosine above it, as in visibility maps; those that a normal map turns into the surface meet the texel
    /// itself.
    ///
    /// @param dst      set to three floats a texel; in the margin the mean of neighbours whose normals are alike; 0
    ///                 elsewhere. The same bits for any number of threads
    /// @param map      R of the map's texels, three floats each
    /// @param points   R of points(), three floats each
    /// @returns false if `progress` stopped the work, a span has another size, or prepare() has not succeeded
    bool gather(std::vector<float>& dst, OIIO::cspan<float> map, OIIO::cspan<float> points, int nthreads = 0,
                const Progress& progress = {}) const;

    /// Whether gather() needs no rays.
    bool is_kept() const { return m_is_kept; }
    /// Rays so far: of prepare(), and of gather() if nothing is kept.
    int64_t rays() const { return m_rays; }
    /// After prepare(): whether a triangle covers the texel with this index.
    bool is_covered(size_t texel) const;
    size_t bytes() const;

private:
    struct Setup;
    struct Worker;
    void trace(int tile, Worker& worker) const;
    bool trace_all(double memory, std::string& error, int nthreads, const Progress& progress);

    std::unique_ptr<Setup> m_setup;
    std::vector<TransportTile> m_tiles;
    std::vector<LightPoint> m_points;
    std::vector<SurfacePoint> m_surfaces;
    bool m_is_kept = false;
    mutable std::atomic<int64_t> m_rays { 0 };
};

} // namespace vmlight
