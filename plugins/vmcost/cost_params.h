// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/vismap/vismap.h>

#include <limits>

namespace vmlight::cost {

struct CostParams
{
    /// 0 means the default, which depends on `quick`.
    int resolution = 0, reference_samples = 0;
    int seed = 0;
    bool sanitize = false, quick = false, no_plots = false;
    /// As VismapParams: of the reference and of all maps.
    bool ground = false;
    double ground_height = VismapParams::kLowest, max_distance = std::numeric_limits<double>::infinity();

    int side() const { return resolution ? resolution : quick ? 128 : 256; }
    /// Set what of the scene is not in its meshes.
    void set_scene(VismapParams& map) const
    {
        map.ground = ground;
        map.ground_height = ground_height;
        map.max_distance = max_distance;
    }
    int pairs() const { return reference_samples ? reference_samples : quick ? 128 : 1024; }

    template <class Visit> void visit(Visit&& field)
    {
        field("resolution", resolution, Range { 8, 4096, "auto", 0 },
              "Size of the reference in texels; auto: 256, or 128 with --quick");
        field("reference_samples", reference_samples, Range { 2, 1 << 20, "auto", 0 },
              "Pairs of rays per texel of the reference; auto: 1024, or 128 with --quick");
        field("seed", seed, Range { 0, 1000000000 }, advanced("Random seed of bakes and reference"));
        field("quick", quick, Flag {}, "Fewer settings and a small reference: takes about half a minute");
        field("no_plots", no_plots, Flag {}, "Skip the plots, which need gnuplot");
        field("sanitize", sanitize, Flag {}, "Repair NaN, infinite and negative pixels of the environments");
        field("ground", ground, Flag {}, "Let everything below a horizontal plane occlude, without end");
        field("ground_height", ground_height, Range { -1e30, 1e30, "lowest", VismapParams::kLowest },
              "Height of the ground, in mesh units; lowest: the lowest point of the mesh");
        field("max_distance", max_distance, Range { 1e-30, 1e30, "infinite", std::numeric_limits<double>::infinity() },
              "Maximum occluder distance, in mesh units");
    }
};

} // namespace vmlight::cost
