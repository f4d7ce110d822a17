// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage_main.h>

using namespace vmlight;

int main(int argc, const char** argv)
{
    VismapRecipe recipe;
    StageMain stage("makevismap", "bake how much each texel of a mesh sees, and which way on average", { "MESH" },
                    "  makevismap hero.obj -o hero_vismap.exr --resolution 2048 --samples 256\n"
                    "  makevismap hero.glb --occluder ground.obj --occluder tree.ply -o hero_vismap.exr\n"
                    "  makevismap hero.glb --samples 256 --print-recipe > hero.vismap\n"
                    "  makevismap hero.vismap -o hero_vismap.exr");
    stage.params("Visibility:", recipe.vismap_params);
    stage.params("Mesh:", recipe.mesh_params);
    stage.recipe("Inputs:", recipe, [&](const auto& operands) { recipe.mesh = operands[0]; });

    return stage.run(argc, argv, [&](std::string& error) {
        OIIO::ImageBuf vismap;
        if (!make_image(vismap, recipe, stage.make_options())) {
            error = vismap.geterror();
            return false;
        }
        return stage.write(vismap, error);
    });
}
