// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/main.h>
#include <vmlight/cli/udim_run.h>

using namespace vmlight;

int main(int argc, const char** argv)
{
    CfemRecipe recipe;
    StageMain stage("makecfem", "filter a lat-long environment for diffuse lighting (cosine convolution)",
                    { "ENVIRONMENT" },
                    "  makecfem studio.exr --stack -o studio_cfem.exr\n"
                    "  makecfem sky.hdr --colorconfig config.ocio --resolution 512 -o sky_cfem.exr\n"
                    "  makecfem studio.exr --filter sh --order 2 -o studio_sh2.exr\n"
                    "  makecfem studio.cfem -o studio_cfem.exr");
    UdimRun tiles(stage, recipe);
    stage.params("Filter:", recipe.cfem_params);
    stage.option("stack", "", "Write a stack: filters of several widths and the environment itself, for all models",
                 [&](auto, auto&) { return recipe.stack = true; });
    stage.recipe(
        "Inputs:", recipe, [&](const auto& operands) { recipe.environment = operands[0]; },
        [&] { return tiles.unsavable(); });

    const auto make = [&](const auto& tile, const auto& output, const auto& options, std::string& error) {
        std::vector<OIIO::ImageBuf> levels; // several if it is a stack
        return make_images(levels, tile, options, error) && stage.write(levels, output, error);
    };
    return stage.run(argc, argv, [&](std::string& error) { return tiles.make_tiles(make, error); });
}
