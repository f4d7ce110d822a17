// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/recipe/check.h>

#include <vmlight/lightmap/model.h>

#include <OpenImageIO/strutil.h>

namespace vmlight {

std::string unused_reason(const VismapRecipe& recipe, const std::string& key)
{
    if (key == "crease_angle" && recipe.mesh_params.normals == "flat")
        return "flat normals have no creases";
    if (key == "resolution" && recipe.vismap_params.width && recipe.vismap_params.height)
        return "width and height take its place";
    if (key == "order" && recipe.vismap_params.basis != "sh")
        return "only the basis sh has bands";
    const bool has_target = recipe.vismap_params.target_error > 0;
    if ((key == "samples" || key == "time_budget") && has_target)
        return "target_error says how many rays it takes";
    if (key == "samples" && recipe.time_budget > 0)
        return "time_budget says how many rays there is time for";
    return "";
}

std::string unused_reason(const CfemRecipe& recipe, const std::string& key)
{
    return key == "order" && recipe.cfem_params.filter != "sh" ? "only the filter sh uses it" : "";
}

std::string unused_reason(const LightmapRecipe& recipe, const std::string& key)
{
    const bool is_filter = OIIO::Strutil::starts_with(key, "cfem_");
    if ((is_filter || key == "colorspace") && !recipe.cfem.empty())
        return OIIO::Strutil::fmt::format("there is no environment to {}: \"{}\" is filtered already",
                                          is_filter ? "filter" : "convert", recipe.cfem);
    const std::string& model = recipe.lightmap_params.model;
    if ((key == "cfem_filter" || key == "cfem_order") && reads_radiance(model))
        return "the model " + model + " reads the environment unfiltered";
    if (key == "cfem_order" && recipe.cfem_params.filter != "sh")
        return "only the filter sh uses it";
    if (key == "albedo_colorspace" && recipe.albedo.empty())
        return "there is no albedo";
    return "";
}

} // namespace vmlight
