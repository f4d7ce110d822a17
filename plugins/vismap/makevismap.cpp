// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/main.h>
#include <vmlight/cli/udim_run.h>
#include <vmlight/vismap/basis.h>

using namespace vmlight;

int main(int argc, const char** argv)
{
    VismapRecipe recipe;
    StageMain stage("makevismap", "bake how much each texel of a mesh sees, and which way on average", { "MESH" },
                    "  makevismap hero.obj -o hero_vismap.exr --resolution 2048 --samples 256\n"
                    "  makevismap hero.obj -o 'hero_vismap.<UDIM>.exr'\n"
                    "  makevismap hero.glb --occluder ground.obj --occluder tree.ply -o hero_vismap.exr\n"
                    "  makevismap hero.glb --samples 256 --print-recipe > hero.vismap\n"
                    "  makevismap hero.vismap -o hero_vismap.exr");
    UdimRun tiles(stage, recipe);
    stage.params("Visibility:", recipe.vismap_params);
    stage.option("time_budget", "SECONDS", "Take as many rays as a map's bake has time for on this machine",
                 [&](OIIO::string_view text, std::string& error) {
                     if (parse_value(recipe.time_budget, text, Range { 1e-3, 1e6 }, error))
                         return true;
                     error = "time_budget: " + error;
                     return false;
                 });
    stage.params("Mesh:", recipe.mesh_params);
    const auto unsaid
        = [&] { return recipe.time_budget > 0 ? "a recipe holds no --time-budget: machines differ" : tiles.unsaid(); };
    stage.recipe(
        "Inputs:", recipe, [&](const auto& operands) { recipe.mesh = operands[0]; }, unsaid);

    stage.check([&] {
        const std::string& basis = recipe.vismap_params.basis;
        return stage.pixel_format() == "half" && find_basis(basis).whole_numbers
            ? "--format half: the basis " + basis + " holds whole numbers that half cannot store exactly"
            : std::string();
    });

    const auto make = [&](const auto& tile, const auto& output, const auto& options, std::string& error) {
        OIIO::ImageBuf vismap;
        if (!make_image(vismap, tile, options))
            error = vismap.geterror();
        return error.empty() && stage.write(vismap, output, error);
    };
    return stage.run(argc, argv, [&](std::string& error) { return tiles.each(make, error); });
}
