// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/overlap_hint.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/stage/uv_sets.h>
#include <vmlight/uv/raster.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <memory>

namespace vmlight {
namespace {

// Percent of the covered texels. Careless unwraps share up to 2 %; mirrored, tiled and stacked islands 30 % and more.
constexpr double kHeavy = 5;
// Enough to tell heavy overlap from none, in a fraction of a second.
constexpr int kMostTexels = 1024;
constexpr size_t kMostParts = 64, kMostNamed = 4;

// Triangles that no map of the tile shows.
int64_t lost_triangles(const UvReport& uv)
{
    return uv.without_uv + uv.degenerate_uv + uv.fully_outside;
}

// The percentage of texels that several triangles share; -1 if the mesh covers none, or loses more than `most_lost`
// triangles.
double measure_overlap(const Mesh& mesh, const VismapParams& params, int64_t most_lost)
{
    const Size size = params.size();
    const UvRaster raster(mesh, std::min(size.width, kMostTexels), std::min(size.height, kMostTexels), params.udim);
    if (lost_triangles(raster.report()) > most_lost)
        return -1;
    const auto cover = std::make_unique<TileCover>();
    int64_t covered = 0, overlapping = 0;
    for (int tile = 0; tile < raster.tiles_across() * raster.tiles_down(); ++tile) {
        raster.cover(tile, *cover);
        covered += cover->covered;
        overlapping += cover->overlapping;
    }
    return covered ? percent_of(overlapping, covered) : -1;
}

std::string percent_text(double percent)
{
    return format("{:.{}f} %", percent, percent > 0 && percent < 10 ? 1 : 0);
}

std::string better_uv_set(const VismapReport& report, const VismapRecipe& recipe)
{
    int best = -1;
    double least = kHeavy;
    // A set of a few decals is no choice for the whole mesh.
    const int64_t most_lost = lost_triangles(report.uv) + report.uv.triangles / 100;
    for_each_other_uv_set(recipe, [&](int set, const Mesh& part) {
        const double overlap = measure_overlap(part, recipe.vismap_params, most_lost);
        if (overlap >= 0 && overlap < least) {
            least = overlap;
            best = set;
        }
    });
    return best < 0
        ? ""
        : format("UV set {} overlaps {}, set {} {}: try --uv-set {}", best, percent_text(least),
                 recipe.mesh_params.uv_set, percent_text(percent_of(report.overlapping, report.covered)), best);
}

// What makes a map for each material or instance.
struct PartKind
{
    std::vector<std::string> names;
    std::vector<std::string> MeshSelection::*chosen;
    const char *noun, *nouns, *pattern;
};

std::string better_by_part(const PartKind& kind, const Mesh& mesh, const VismapRecipe& recipe)
{
    const std::vector<std::string>& names = kind.names;
    if (names.size() < 2 || names.size() > kMostParts)
        return "";
    double most = 0;
    for (const std::string& name : names) {
        std::vector<bool> chosen;
        std::string at, error;
        MeshSelection selection;
        selection.*kind.chosen = { name };
        if (!choose_triangles(chosen, mesh, selection, at, error))
            return "";
        most = std::max(most,
                        measure_overlap(mesh_part(mesh, chosen), recipe.vismap_params, int64_t(mesh.triangles.size())));
    }
    if (most >= kHeavy)
        return "";
    const std::vector<std::string> named(names.begin(),
                                         names.begin() + std::ptrdiff_t(std::min(names.size(), kMostNamed)));
    const std::string more = names.size() > kMostNamed ? format(" and {} more", names.size() - kMostNamed) : "";
    return format("{} {}{} overlap {}{} each: try {} in -o, for one map {} {}", kind.nouns,
                  shortened_line(OIIO::Strutil::join(named, ", ")), more, most > 0 ? "at most " : "",
                  percent_text(most), kind.pattern, kind.noun[0] == 'i' ? "an" : "a", kind.noun);
}

} // namespace

bool has_heavy_overlap(const VismapReport& report)
{
    return percent_of(report.overlapping, report.covered) >= kHeavy;
}

std::string overlap_hint(const VismapReport& report, const Mesh& mesh, const VismapRecipe& recipe)
{
    const std::string by_set = better_uv_set(report, recipe);
    const PartKind materials { baked_materials(mesh), &MeshSelection::material, "material", "materials", "<MATERIAL>" };
    const PartKind instances { baked_instances(mesh), &MeshSelection::node, "instance", "instances", "<INSTANCE>" };
    // Materials without names tell nobody anything.
    const bool has_names = std::any_of(mesh.materials.begin(), mesh.materials.end(),
                                       [](const Material& material) { return !material.name.empty(); });
    std::string by_part = better_by_part(has_names ? materials : instances, mesh, recipe);
    if (by_part.empty())
        by_part = better_by_part(has_names ? instances : materials, mesh, recipe);
    return by_set + (by_set.empty() || by_part.empty() ? "" : "; or ") + by_part;
}

} // namespace vmlight
