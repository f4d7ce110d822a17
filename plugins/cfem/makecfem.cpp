// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage_main.h>

using namespace vmlight;

int main(int argc, const char** argv)
{
    CfemRecipe recipe;
    StageMain stage("makecfem", "filter an environment with a cosine: the diffuse light for each direction",
                    { "ENVIRONMENT" },
                    "  makecfem studio.exr -o studio_cfem.exr\n"
                    "  makecfem sky.hdr --colorconfig config.ocio --resolution 512 -o sky_cfem.exr\n"
                    "  makecfem studio.cfem -o studio_cfem.exr");
    stage.params("Filter:", recipe.cfem_params);
    stage.recipe("Inputs:", recipe, [&](const auto& operands) { recipe.environment = operands[0]; });

    return stage.run(argc, argv, [&](std::string& error) {
        OIIO::ImageBuf cfem;
        if (!make_image(cfem, recipe, stage.make_options())) {
            error = cfem.geterror();
            return false;
        }
        return stage.write(cfem, error);
    });
}
