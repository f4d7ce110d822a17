// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/strand_object.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/image/channels.h>
#include <vmlight/mesh/import/strands/read_strands.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/open_source.h>

#include <vector>

namespace vmlight {

bool StrandObject::open(const VismapRecipe& recipe, std::string& error)
{
    auto read = std::make_shared<Strands>();
    if (!read_strands(*read, recipe.mesh, recipe.mesh_params, recipe.strand_params.radius, error)
        || !StrandLayout::make(layout, read->count(), recipe.strand_params.strand_texels, error))
        return false;
    auto around = std::make_shared<Mesh>();
    around->name = read->name;
    around->path = read->path;
    around->strands = std::move(read);
    surface = std::make_shared<StrandSurface>(around->strands, layout);
    mesh = std::move(around);
    return true;
}

bool read_strand_map(OIIO::ImageBuf& dst, const StrandObject& object, const std::string& path,
                     const MakeOptions& options, std::string& error)
{
    LightmapRecipe recipe;
    recipe.vismap = path;
    const PixelSourcePointer source = open_input(recipe, "vismap", path, InputKind::Vismap, error, {});
    std::vector<OIIO::ImageBuf> images;
    if (!source || !make_input(images, *source, {}, recipe, "vismap", path, options, error))
        return false;
    const OIIO::ImageSpec& spec = images[0].spec();
    const Size size = object.layout.size();
    if (kernel_of(spec) != kStrandKernel)
        error = format("\"{}\": a visibility map of a mesh, not of strands", path);
    else if (spec.width != size.width || spec.height != size.height)
        error = format("\"{}\": {}x{} texels, and \"{}\" needs {}x{} with {} along each strand: set --strand-texels to "
                       "what it was baked with",
                       path, spec.width, spec.height, object.mesh->path, size.width, size.height, object.layout.texels);
    if (!error.empty())
        return false;
    dst = std::move(images[0]);
    return true;
}

bool bake_strand_map(OIIO::ImageBuf& dst, const StrandObject& object, const StrandScene& scene,
                     const VismapRecipe& recipe, const MakeOptions& options, std::string& error)
{
    const Stopwatch timer;
    int64_t rays = 0;
    const VismapParams& params = recipe.vismap_params;
    const StrandBaker baker(object.strands(), scene, object.layout, params);
    const OIIO::ImageSpec spec = describe_strand_map(object.strands(), object.layout, recipe.strand_params, params);
    if (!make_strand_map(dst, spec, baker, options.threads, rays, options.step("bake", spec.width, spec.height))) {
        error = oiio::error_line(dst);
        return false;
    }
    options.report(format("bake: {}: {} of {}, {} rays each, in {:.2f} s", object.mesh->name,
                          count_text(object.layout.strands, "strand", "strands"),
                          count_text(object.layout.texels, "texel", "texels"), params.samples, timer()));
    return true;
}

} // namespace vmlight
