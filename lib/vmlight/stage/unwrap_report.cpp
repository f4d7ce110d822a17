// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/unwrap_report.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/uv/unwrap_pack.h>

namespace vmlight {

std::string unwrap_line(const UnwrapReport& report, const UnwrapParams& params)
{
    return format("unwrap: {} {} {:.1f} % of {}x{} texels, {} apart; {:.4g} texels per unit, stretch {:.3f}; {:.2f} s",
                  count_text(report.charts, "chart", "charts"), plural(report.charts, "covers", "cover"),
                  100 * report.coverage, params.width, params.height, count_text(unwrap_gap(params), "texel", "texels"),
                  report.density, report.stretch, report.seconds);
}

std::string unwrap_warning(const UnwrapReport& report)
{
    const int64_t lost = report.without_area + report.too_thin;
    return lost == 0
        ? ""
        : format("unwrap: {} no area in the atlas: {} without area in space, {} thinner than UVs can resolve",
                 count_text(lost, "triangle has", "triangles have"), report.without_area, report.too_thin);
}

} // namespace vmlight
