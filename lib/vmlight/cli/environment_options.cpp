// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/environment_options.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/importer.h>

namespace vmlight {

void add_environment_options(StageMain& stage, CfemRecipe& recipe)
{
    stage.option("colorspace", "SPACE",
                 advanced("Colour space of the environment; default: from its name and metadata"), recipe.colorspace);
    stage.option("colorconfig", "FILE", advanced("OCIO config; default: $OCIO"), recipe.colorconfig);
    stage.option("layer", "LAYER", advanced("Layer or part of the environment to read, such as ViewLayer.Combined"),
                 recipe.layer);
    stage.option("layout", "auto|latlong", advanced("latlong: the environment is lat-long, whatever its shape [auto]"),
                 [&recipe](auto text, auto& error) { return set_param(recipe, "layout", text, error); });
}

std::string operand_order_fault(const std::string& mesh, const std::string& environment)
{
    if (!is_mesh_name(environment) || is_mesh_name(mesh))
        return "";
    return format("\"{}\" is a mesh: give it first, then the environment", environment);
}

} // namespace vmlight
