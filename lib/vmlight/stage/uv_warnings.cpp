// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/uv_warnings.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/uv/raster.h>
#include <vmlight/uv/udim.h>

#include <algorithm>
#include <vector>

namespace vmlight {
namespace {

// Of a map that UVs are rounded to.
constexpr int kSide = 1024;

} // namespace

std::string beyond_udims_warning(const UvReport& uv)
{
    return uv.beyond_udims == 0
        ? ""
        : format("{} of {} {} outside all UDIM tiles (u below 0 or above 10, or v below 0): that part is not baked; "
                 "move its UVs into a tile",
                 uv.beyond_udims, count_text(uv.triangles, "triangle", "triangles"),
                 plural(uv.beyond_udims, "reaches", "reach"));
}

std::string without_uv_warning(const UvReport& uv)
{
    return uv.without_uv == 0 ? ""
                              : format("{} of {} {}", uv.without_uv, count_text(uv.triangles, "triangle", "triangles"),
                                       plural(uv.without_uv, "has no UVs: it occludes, but is not baked",
                                              "have no UVs: they occlude, but are not baked"));
}

void warn_of_uvs(const Mesh& mesh, OIIO::cspan<int> tiles, const MakeOptions& options)
{
    const UvReport uv = UvRaster(mesh, kSide, kSide, kFirstUdim).report();
    std::string others;
    for (const int udim : mesh_udims(mesh))
        if (std::find(tiles.begin(), tiles.end(), udim) == tiles.end())
            others += (others.empty() ? "" : ", ") + std::to_string(udim);
    if (!others.empty())
        others = "no visibility map for UDIM tile " + others + ", which the mesh uses: no light there";
    for (const std::string& warning : { beyond_udims_warning(uv), without_uv_warning(uv), others })
        if (!warning.empty())
            options.report_warning(format("{}: {}", mesh.name, warning));
}

} // namespace vmlight
