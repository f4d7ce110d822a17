// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/params.h>

namespace vmlight::cost {

struct CostParams
{
    /// 0 leaves it to `quick`.
    int resolution = 0, reference_samples = 0;
    int seed = 0;
    bool sanitize = false, quick = false, no_plots = false;

    int side() const { return resolution ? resolution : quick ? 128 : 256; }
    int pairs() const { return reference_samples ? reference_samples : quick ? 128 : 1024; }

    template <class Visit> void visit(Visit&& field)
    {
        field("resolution", resolution, Range { 8, 4096, "auto", 0 },
              "Side of the reference, in texels; auto is 256, or 128 with --quick");
        field("reference_samples", reference_samples, Range { 2, 1 << 20, "auto", 0 },
              "Pairs of rays a texel of the reference; auto is 1024, or 128 with --quick");
        field("seed", seed, Range { 0, 1000000000 }, "Another seed, other noise in bakes and reference");
        field("quick", quick, Flag {}, "Fewer settings, a small reference: half a minute");
        field("no_plots", no_plots, Flag {}, "Do without gnuplot");
        field("sanitize", sanitize, Flag {}, "Mend NaN, infinite and negative pixels of the environments");
    }
};

} // namespace vmlight::cost
