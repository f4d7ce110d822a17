// SPDX-License-Identifier: Apache-2.0
/// The error of a map that is reconstructed, from small windows of it and texels in them that are traced with more
/// rays.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/surface.h>
#include <vmlight/uv/raster.h>
#include <vmlight/vismap/neighbour_weights.h>
#include <vmlight/vismap/open_triangles.h>
#include <vmlight/vismap/pilot.h>
#include <vmlight/vismap/seam_links.h>
#include <vmlight/vismap/visibility_integrator.h>
#include <vmlight/vismap/vismap.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vmlight {

/// The error of a reconstructed map at some number of rays.
struct ReconstructError
{
    /// Root mean square of V's, bias included.
    double rms = 0;
    /// Factor for the standard error that the filter expects that makes its root mean square that of V.
    double scale = 1;
};

class ReconstructPilot
{
public:
    /// @param scene, pilot must outlive this; the latter has picked its texels
    /// @param params   is_reconstructed()
    ReconstructPilot(const BakeScene& scene, const VismapPilot& pilot, const VismapParams& params, int nthreads,
                     const Progress& progress);

    /// Choose the windows, and find what they cover: around texels of the pilot, evenly over the map, and beyond the
    /// seams of the islands in their middle. Where a few rays say that neighbours differ there are more of them, each
    /// of which counts less: few texels of a large map have most of its error. False if stopped.
    bool pick(const UvRaster& raster, const OpenTriangles& open, const SeamLinks& seams);

    /// Bake and reconstruct the windows, and trace their middles twice with 8 times the rays and other seeds: the
    /// product of the two differences is an unbiased estimate of the squared error. Measured on ten meshes: within 25
    /// % of the root mean square of the map. The same bits for every number of threads. False if stopped.
    ///
    /// @param plain    the error of rays alone, and their number, as the pilot measured it
    /// @param pattern_error  the function of this name, at that number
    bool measure(const PilotError& plain, double pattern_error, ReconstructError& dst) const;

    /// What measure() traces, in texels of the map with their rays: after pick(). Windows of a small map share most of
    /// their texels, and each is traced once.
    int64_t traced_texels() const;

private:
    /// The texel in the middle, whose error is measured, and around it what it is reconstructed from.
    static constexpr int kSide = 1 + 2 * NeighbourWindow::kHalo, kMiddle = kSide * kSide / 2;
    struct Texel
    {
        SurfacePoint point;
        int x = 0, y = 0;
        float spacing = 0; // 0: not covered
        bool open = false;
        uint32_t island = 0;
        bool continues = false; // what lies beyond a seam
    };
    struct Window
    {
        std::array<Texel, kSide * kSide> texels;
        std::array<uint32_t, kSide * kSide> traced; ///< each in m_traced
        double counts = 1; ///< for so many
    };
    static constexpr uint32_t kNotTraced = ~0u;
    bool choose(const UvRaster& raster, const OpenTriangles& open, const SeamLinks& seams);
    bool fill(const std::vector<Texel*>& texels, const UvRaster& raster, const OpenTriangles& open,
              const SeamLinks& seams) const;
    bool continue_windows(const UvRaster& raster, const OpenTriangles& open, const SeamLinks& seams);
    void find_traced();
    // Sets `dst` to what each of `texels` sees, with patterns that complement each other, or that are independent.
    // False if stopped.
    bool trace(std::vector<Visibility>& dst, const std::vector<const Texel*>& texels, const SamplePattern& pattern,
               int seed, bool is_independent) const;

    const BakeScene& m_scene;
    const VismapPilot& m_pilot;
    VismapParams m_params;
    const int m_threads;
    const Progress m_progress;
    std::vector<Window> m_windows;
    std::vector<const Texel*> m_traced; // of all windows, each once
    std::vector<const Texel*> m_middles; // likewise of the middles
    std::vector<uint32_t> m_middle_of; // by number in m_traced, the number in m_middles
};

} // namespace vmlight
