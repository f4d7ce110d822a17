// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/params.h>

namespace vmlight::cost {

struct CostParams
{
    /// 0 means the default, which depends on `quick`.
    int resolution = 0, reference_samples = 0;
    int seed = 0;
    bool sanitize = false, quick = false, no_plots = false;

    int side() const { return resolution ? resolution : quick ? 128 : 256; }
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
    }
};

} // namespace vmlight::cost
