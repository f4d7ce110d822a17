// SPDX-License-Identifier: Apache-2.0
/// Which surfaces light which texels of a map, and by how much: what light takes on its first bounce, whatever the
/// light.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/vismap/light_cells.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/span.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

struct TransportMap;
struct TransportTile;

struct TransportParams
{
    /// Rays per texel, 8 to 248.
    int rays = 64;
    /// Whether the ground sends light back; it is black otherwise.
    bool ground = false;
    /// Keep what rays met, so that new light needs none, if that takes no more bytes; else they are traced each time.
    size_t most_bytes = size_t(1) << 30;
};

class LightTransport
{
public:
    LightTransport();
    ~LightTransport();

    /// Trace the rays of all texels that something blocks the view of.
    ///
    /// @param scene    built, with SceneChoice::cull off where that leaves out occluders, which may shade what texels
    ///                 see. Occluders reflect light on both sides, and so does the mesh
    /// @param map      size, UDIM tile, maximum distance, ground, margin, measure and seed, as for the visibility map
    ///                 of the same texels
    /// @param visibility   V of that map, one float a texel. Texels with V >= 1 trace no ray, and those of the measure
    ///                 `cosine` take 1 - V for what is blocked; empty: all of it is found by rays
    /// @returns false, with the reason in `error`, if a parameter is out of range, memory does not suffice, or
    ///          `progress` stopped the work
    bool prepare(BakeScenePointer scene, const VismapParams& map, OIIO::cspan<float> visibility,
                 const TransportParams& params, std::string& error, int nthreads = 0, const Progress& progress = {},
                 NormalMapPointer normal_map = nullptr);

    /// After prepare(): the points that light texels and are on none.
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
    /// @returns false if `progress` stopped the work
    bool gather(std::vector<float>& dst, OIIO::cspan<float> map, OIIO::cspan<float> points, int nthreads = 0,
                const Progress& progress = {}) const;

    /// Whether gather() needs no rays.
    bool is_kept() const { return m_is_kept; }
    /// Rays so far: of prepare(), and of gather() if nothing is kept.
    int64_t rays() const { return m_rays; }
    size_t bytes() const;

private:
    void clear();
    bool check_memory(const VismapParams& map, OIIO::cspan<float> visibility, const TransportParams& params,
                      std::string& error);
    bool trace_all(std::string& error, int nthreads, const Progress& progress);
    void number_points();
    std::vector<Imath::V3f> light_of(OIIO::cspan<float> map, OIIO::cspan<float> points, int nthreads) const;

    std::unique_ptr<TransportMap> m_map;
    std::vector<TransportTile> m_tiles;
    std::vector<LightPoint> m_points;
    std::vector<SurfacePoint> m_surfaces;
    std::vector<uint32_t> m_first_point; // of each cell, and the end
    bool m_is_kept = false;
    mutable int64_t m_rays = 0;
};

} // namespace vmlight
