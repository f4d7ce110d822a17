// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/cli/animation.h>
#include <vmlight/cli/main.h>
#include <vmlight/cli/udim_run.h>
#include <vmlight/cli/watch.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/light_level.h>
#include <vmlight/stage/light_effects.h>
#include <vmlight/stage/light_forecast.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/uv/udim.h>

#include <ctime>

using namespace vmlight;

namespace {

constexpr const char* kExamples
    = "  makelightmap hero_vismap.exr studio.exr --rotate 0,90,0 -o hero_lit.exr\n"
      "  makelightmap hero_vismap.exr studio.exr --frames 1-48 --rotate-y 0:352.5 -o hero_lit.####.exr\n"
      "  makelightmap hero_vismap.exr sky.####.exr --frames 1-48 -o hero_lit.####.exr\n"
      "  makelightmap 'hero_vismap.<UDIM>.exr' studio.exr -o 'hero_lit.<UDIM>.exr'\n"
      "  makelightmap hero.vismap sunny.exr --suns auto -o hero_lit.exr\n"
      "  makelightmap hero.lightmap --exposure 1 -o hero_lit.exr\n"
      "  makelightmap hero.lightmap --watch -o hero_lit.exr";

// One exposure for all frames and tiles, from the first that is made.
struct AutoExposure
{
    bool wanted = false, known = false;
    double stops = 0;
};

std::string level_text(const LightLevel& level, double exposure)
{
    if (level.texels == 0)
        return "light: no texel is lit";
    return format("light: luminance of {}: mean {:.3g}, 95th percentile {:.3g}; {}",
                  count_text(level.texels, "lit texel", "lit texels"), level.mean, level.percentile95,
                  level.gray_exposure(exposure).advice());
}

// Keeps in `inputs` what the next run may need of them.
int light(int argc, const char** argv, LightmapInputs& inputs, Watch& watch)
{
    LightmapRecipe recipe;
    Animation animation;
    AutoExposure exposure;
    StageMain stage("makelightmap", "light a visibility map with an environment", { "VISMAP", "ENVIRONMENT_OR_CFEM" },
                    kExamples);
    UdimRun tiles(stage, recipe);
    stage.group("Light:");
    stage.option(
        "exposure", "-64..64|auto",
        "Exposure in stops; auto: brings the mean luminance of the first frame (and tile) to 0.18, and is used "
        "for all [0]",
        [&](OIIO::string_view text, std::string& error) {
            exposure.wanted = text == "auto";
            recipe.lightmap_params.exposure = exposure.wanted ? 0 : recipe.lightmap_params.exposure;
            return exposure.wanted || set_param(recipe, "exposure", text, error);
        });
    stage.params("Light:", recipe.lightmap_params);
    bool explain = false;
    stage.group("Effects:");
    stage.params("Effects:", recipe.bounce_params);
    stage.option("explain", "", "Print before lighting which effects are simulated, and why",
                 [&](auto, auto&) { return explain = true; });
    stage.dry_run("Print the same with the expected time and memory, and write nothing; -o may be left out. Reads "
                  "and filters the inputs");
    stage.group("Frames:");
    stage.option("frames", "RANGE", "Frames to make, such as 1-48, with #### in -o, and in inputs that are sequences",
                 [&](auto text, auto& error) {
                     animation.has_frames = true;
                     return parse_frames(animation.frames, std::string(text), error);
                 });
    stage.option("rotate_y", "FIRST:LAST",
                 "Turntable: degrees about y at the first and last frame, after the other rotations",
                 [&](auto text, auto& error) { return parse_ramp(animation.rotate_y, std::string(text), error); });
    stage.group(kOutputHeading);
    watch.add_flag(stage);
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
        [&]() -> std::string {
            if (animation.has_frames || animation.rotates())
                return "--frames and --rotate-y cannot be saved in a recipe";
            if (stage.is_dry_run())
                return "--dry-run cannot be saved in a recipe";
            if (explain)
                return "--explain cannot be saved in a recipe";
            if (watch.is_given())
                return "--watch cannot be saved in a recipe";
            return exposure.wanted ? "--exposure auto cannot be saved in a recipe: give the stops that it prints"
                                   : tiles.unsavable();
        });

    stage.check([&] {
        const char* const flag = animation.has_frames ? "--frames"
            : stage.is_dry_run()                      ? "--dry-run"
            : explain                                 ? "--explain"
            : has_udim_pattern(stage.output())        ? "<UDIM> in -o; give --udim"
                                                      : "";
        return watch.is_given() && *flag ? format("--watch makes one image again and again: not with {}", flag) : "";
    });
    stage.check([&] { return animation.fault(stage.output()); });
    stage.check([&] { return animation.input_fault(recipe); });
    stage.check([&] {
        // Until there were frames, nobody could look into the first file of a sequence.
        const std::string first = animation.inputs_at(recipe, 0).environment;
        if (!first.empty() && first != recipe.environment && image_stage(first) == kCfemStage)
            recipe.cfem.swap(recipe.environment);
        return std::string();
    });

    stage.check([&] {
        return stage.is_dry_run() && !recipe_stage(recipe.vismap).empty() ? format(
                   "--dry-run: \"{}\" is a recipe, whose map would have to be baked: makevismap {} --dry-run says what "
                   "that takes",
                   recipe.vismap, recipe_path(recipe.vismap))
                                                                          : std::string();
    });

    Forecasts forecasts;
    const auto make = [&](const auto& tile, const auto& output, const MakeOptions& given, std::string& error) {
        MakeOptions options = given;
        const LightWork before = LightWork::so_far();
        double seconds = 0;
        for (size_t i = 0; i < animation.frames.size(); ++i) {
            const LightmapRecipe asked = animation.inputs_at(tile, i), frame = with_switches(asked);
            Stopwatch reading;
            const std::clock_t begin = std::clock();
            if (!read_lightmap_inputs(inputs, frame, options, error)
                || !(error = watch.output_fault(stage.output())).empty())
                return false;
            TimeTaken taken { reading(), 0 };
            LightmapParams params = animation.params_at(frame.lightmap_params, i, error);
            options.explain = explain && i == 0;
            options.dry_run = stage.is_dry_run();
            options.forecasts = &forecasts;
            // The frames have the same switches, and about the same light.
            if (i == 0 && (explain || options.dry_run || asked.effects != "auto") && error.empty()
                && !explain_light(inputs, { asked, animation.params_at(asked.lightmap_params, i, error), params },
                                  options, error))
                return false;
            if (options.dry_run && error.empty()) {
                LightPlan plan { animation.frames.size() };
                options.say = options.warn = nullptr;
                reading.lap();
                if (plan.frames > 1
                    && !read_lightmap_inputs(inputs, with_switches(animation.inputs_at(tile, 1)), options, error))
                    return false;
                plan.next_read = reading();
                taken.processor = double(std::clock() - begin) / CLOCKS_PER_SEC;
                options.say = given.say;
                return forecast_light(inputs, params, plan, taken, options, error);
            }
            if (exposure.known)
                params.exposure = exposure.stops;
            OIIO::ImageBuf lightmap;
            const Stopwatch timer;
            if (!error.empty() || !make_lightmap(lightmap, inputs, params, options, error))
                return false;
            seconds += timer();
            if (i == 0 && (exposure.wanted || !stage.is_silent())) {
                const LightLevel level = measure_light(lightmap, inputs.vismap);
                options.report(level_text(level, params.exposure));
                if (exposure.wanted && !exposure.known) {
                    exposure.known = true;
                    const GrayExposure gray = level.gray_exposure(params.exposure);
                    params.exposure = exposure.stops = gray.stops;
                    options.report(format("exposure: {:.2f} stops, for all frames and tiles", exposure.stops));
                    if (level.texels == 0)
                        options.report_warning(
                            "--exposure auto: no texel is lit in the first frame, so 0 stops for all");
                    else if (!gray.is_gray)
                        options.report_warning("--exposure auto: " + gray.advice());
                    if (!make_lightmap(lightmap, inputs, params, options, error))
                        return false;
                }
            }
            tag_udim(lightmap.specmod(), tile.udim);
            if (!stage.write(lightmap, animation.path(output, i), error))
                return false;
            options.say = [](const std::string&) {}; // the rest of the frames have nothing new to say
        }
        given.say(format("light: {} of {}x{} in {:.3f} s",
                         animation.frames.size() == 1 ? "1 map" : format("{} maps", animation.frames.size()),
                         inputs.vismap.spec().width, inputs.vismap.spec().height, seconds));
        if (explain)
            report_taken(before, given);
        return true;
    };
    return stage.run(argc, argv, [&](std::string& error) {
        error = animation.missing_fault(recipe);
        const bool made = error.empty() && tiles.make_tiles(make, error);
        if (const std::string all = forecasts.text(); made && !all.empty())
            stage.answer(all);
        if (made)
            watch.made(stage, stage.output());
        return made;
    });
}

} // namespace

int main(int argc, const char** argv)
{
    LightmapInputs inputs; // frames and tiles share what they can
    Watch watch;
    return watch.run([&] { return light(argc, argv, inputs, watch); });
}
