// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/recipe/unused_flags.h>

#include <vmlight/base/format.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/mesh/import/importer.h>
#include <vmlight/stage/recipe/recipe_effects.h>
#include <vmlight/stage/recipe/strand_recipe.h>
#include <vmlight/vismap/basis.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight {

std::string unused_reason(const VismapRecipe& recipe, const std::string& key)
{
    if (const std::string reason = unused_by_strands(recipe, key); !reason.empty())
        return reason;
    if (key == "crease_angle" && recipe.mesh_params.normals == "flat")
        return "flat normals ignore it";
    if (key == "frame" && !has_time(recipe.mesh)
        && std::none_of(recipe.occluder.begin(), recipe.occluder.end(), has_time))
        return "only Alembic files have frames";
    if (key == "fps" && recipe.mesh_params.frame == MeshParams::kFirstSample)
        return "no frame is given";
    if ((key == "terrain" || key == "height_scale") && !has_heights(recipe.mesh)
        && std::none_of(recipe.occluder.begin(), recipe.occluder.end(), has_heights))
        return "neither the mesh nor an occluder is an image of heights";
    if ((key == "normal_map_space" || key == "normal_map_green") && !recipe.has_normal_map())
        return "no normal map is given";
    if (key == "normal_map_space" && recipe.material_normals)
        return "normal maps of materials are in tangent space";
    if (key == "normal_map_green" && recipe.normal_map_params.normal_map_space == "object")
        return "a normal map in object space has no up and down";
    if (key == "resolution" && recipe.vismap_params.width && recipe.vismap_params.height)
        return "width and height override it";
    if (key == "ground_height" && !recipe.vismap_params.ground)
        return "no ground is given";
    if (key == "reconstruct" && recipe.vismap_params.reconstruct != "off")
        return why_not_reconstructed(recipe);
    const std::string other_basis = unused_basis_parameter(recipe.vismap_params, key);
    if (!other_basis.empty())
        return other_basis;
    const bool has_target = recipe.vismap_params.target_error > 0;
    if ((key == "samples" || key == "time_budget") && has_target)
        return "target_error sets the number of rays";
    if (key == "samples" && recipe.time_budget > 0)
        return "time_budget sets the number of rays";
    return "";
}

std::string unused_reason(const CfemRecipe& recipe, const std::string& key)
{
    return key == "order" && recipe.cfem_params.filter != "sh" ? "only the filter sh uses it" : "";
}

std::string unused_reason(const LightmapRecipe& recipe, const std::string& key)
{
    const bool is_filter = OIIO::Strutil::starts_with(key, "cfem_");
    if ((is_filter || key == "layer" || key == "layout") && !recipe.cfem.empty())
        return format("no environment to {}: \"{}\" is already filtered", is_filter ? "filter" : "read", recipe.cfem);
    const std::string& model = recipe.lightmap_params.model;
    if ((key == "cfem_filter" || key == "cfem_order") && reads_radiance(model))
        return "the model " + model + " reads the unfiltered environment";
    if (key == "cfem_order" && recipe.cfem_params.filter != "sh")
        return "only the filter sh uses it";
    if ((key == "albedo_colorspace" || key == "albedo_layer") && recipe.albedo.empty())
        return "no albedo is given";
    if ((key == "bounce_rays" || key == "bounce_albedo" || key == "ground_albedo") && !wants_bounce(recipe))
        return "no bounced light is asked for: set --bounce auto";
    if (key == "mesh" || key == "occluder") {
        if (!wants_suns(recipe) && !wants_bounce(recipe))
            return "only suns and bounced light are traced: set --suns auto or --bounce auto";
        if (recipe_stage(recipe.vismap) == VismapRecipe::kStage)
            return "the recipe of the visibility map names its meshes";
    }
    return "";
}

} // namespace vmlight
