// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/cli/animation.h>
#include <vmlight/cli/main.h>
#include <vmlight/cli/udim_run.h>
#include <vmlight/image/channels.h>
#include <vmlight/stage/recipe/udim.h>

using namespace vmlight;

int main(int argc, const char** argv)
{
    LightmapRecipe recipe;
    Animation animation;
    StageMain stage("makelightmap", "light a visibility map with an environment", { "VISMAP", "ENVIRONMENT_OR_CFEM" },
                    "  makelightmap hero_vismap.exr studio.exr --rotate 0,90,0 -o hero_lit.exr\n"
                    "  makelightmap hero_vismap.exr studio.exr --frames 1-48 --rotate-y 0:360 -o hero_lit.####.exr\n"
                    "  makelightmap 'hero_vismap.<UDIM>.exr' studio.exr -o 'hero_lit.<UDIM>.exr'\n"
                    "  makelightmap hero.lightmap --exposure 1 -o hero_lit.exr");
    UdimRun tiles(stage, recipe);
    stage.params("Light:", recipe.lightmap_params);
    stage.group("Frames:");
    stage.option("frames", "RANGE", "Frames to make, such as 1-48, with #### in -o", [&](auto text, auto& error) {
        animation.has_frames = true;
        return parse_frames(animation.frames, std::string(text), error);
    });
    stage.option("rotate_y", "FIRST:LAST",
                 "Turntable: degrees about y at the first and last frame, after the other rotations",
                 [&](auto text, auto& error) { return parse_ramp(animation.rotate_y, std::string(text), error); });
    stage.params("Filter:", recipe.cfem_params, "cfem_");
    stage.group("Inputs:");
    stage.option("is_cfem", "", advanced("The second image is cosine-filtered, though its metadata does not say so"),
                 [&](auto, auto&) {
                     if (recipe.cfem.empty())
                         recipe.cfem.swap(recipe.environment);
                     return true;
                 });
    stage.recipe(
        "Inputs:", recipe,
        [&](const auto& operands) {
            recipe.vismap = operands[0];
            (image_stage(operands[1]) == kCfemStage ? recipe.cfem : recipe.environment) = operands[1];
        },
        [&] {
            return animation.has_frames || animation.rotates() ? "--frames and --rotate-y cannot be saved in a recipe"
                                                               : tiles.unsavable();
        });

    stage.check([&] { return animation.fault(stage.output()); });

    LightmapInputs inputs; // tiles share the light
    const auto make = [&](const auto& tile, const auto& output, const MakeOptions& options, std::string& error) {
        if (!read_lightmap_inputs(inputs, tile, options, error))
            return false;
        const Stopwatch timer;
        for (size_t i = 0; i < animation.frames.size(); ++i) {
            const LightmapParams frame = animation.params_at(tile.lightmap_params, i, error);
            OIIO::ImageBuf lightmap;
            if (error.empty()
                && !make_lightmap(lightmap, inputs.vismap, inputs.cfem, frame, inputs.albedo_or_none(), options.threads,
                                  options.progress("light", int64_t(inputs.vismap.spec().image_pixels()))))
                error = lightmap.geterror();
            tag_udim(lightmap.specmod(), tile.udim);
            if (!error.empty() || !stage.write(lightmap, animation.path(output, i), error))
                return false;
        }
        options.say(format("light: {} of {}x{} in {:.3f} s",
                           animation.frames.size() == 1 ? "1 map" : format("{} maps", animation.frames.size()),
                           inputs.vismap.spec().width, inputs.vismap.spec().height, timer()));
        return true;
    };
    return stage.run(argc, argv, [&](std::string& error) { return tiles.make_tiles(make, error); });
}
