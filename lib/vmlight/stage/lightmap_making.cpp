// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/lightmap_making.h>

#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/lightmap/vismap_check.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/bounce_shading.h>
#include <vmlight/stage/light_effects.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/stored_image.h>
#include <vmlight/stage/sun_choice.h>
#include <vmlight/stage/sun_shading.h>
#include <vmlight/stage/whole_light.h>

namespace vmlight {
namespace {

// Here and not where a map is lit: once for all frames.
bool check_map(const OIIO::ImageBuf& vismap, const LightmapPlan& plan, const MakeOptions& options, std::string& error)
{
    std::vector<std::string> warnings;
    if (!check_vismap(vismap, plan.images().vismap->spec(), options.threads, warnings, error)) {
        error
            = with_location(plan.recipe(), "vismap", options.chain, format("\"{}\": {}", plan.recipe().vismap, error));
        return false;
    }
    for (const std::string& line : warnings)
        options.report_warning(format("\"{}\": {}", plan.recipe().vismap, line));
    return true;
}

bool make_light(LightmapInputs& dst, const LightmapPlan& plan, const MakeOptions& options, std::string& error)
{
    const ImageRange range = plan.images_of_use();
    const std::string light = format("{} {} {}", range.first, range.count, plan.images().cfem->key());
    if (dst.light == light)
        return true;
    dst.light.clear();
    dst.cfem.clear();
    const bool filtered = !plan.recipe().cfem.empty();
    if (filtered) {
        if (!make_input(dst.cfem, *plan.images().cfem, range, plan.recipe(), "cfem", plan.recipe().cfem, options,
                        error))
            return false;
        plan.images().light.convert(dst.cfem, options.threads);
        for (const std::string& warning : plan.images().light.warnings)
            options.report_warning(warning);
        if (plan.images().light.conversion)
            options.report("colour: " + plan.images().light.note);
    } else {
        MakeOptions fileless = options; // the implicit CFEM recipe has no file
        fileless.chain.clear();
        if (!plan.images().cfem->make(dst.cfem, range, fileless, error)) {
            error = with_location(plan.recipe(), "environment", options.chain, with_filter_prefix(error));
            return false;
        }
    }
    if (dst.suns && !find_suns(dst.suns->list, plan.recipe(), plan.images(), error))
        return false;
    if (!plan.images().no_suns.empty())
        options.report_warning("suns stay in the environment, with soft shadows: " + plan.images().no_suns);
    if (!plan.images().no_bounce.empty())
        options.report_warning("no bounced light: " + plan.images().no_bounce);
    const bool has_suns = dst.suns && !dst.suns->list.empty();
    const std::string model = has_suns ? with_suns(plan.model().name) : plan.model().name;
    if (plan.recipe().lightmap_params.model == "auto")
        options.report(filtered && plan.model().light == ModelLight::cfem
                           ? format("model: {}, because the CFEM is not a stack (makecfem --stack makes one)", model)
                           : format("model: {}, the best that this visibility map supports", model));
    dst.light = light;
    return true;
}

} // namespace

bool make_lightmap_inputs(LightmapInputs& dst, const LightmapPlan& plan, const MakeOptions& options, std::string& error)
{
    std::vector<OIIO::ImageBuf> images;
    const std::string map = plan.images().vismap->key(),
                      texture = plan.images().albedo ? plan.images().albedo->key() : "";
    // Hold the images of one UDIM tile at a time.
    if (dst.map != map)
        dst.vismap.reset();
    if (dst.texture != texture)
        dst.albedo.reset();
    // The visibility map first: if it fails, no environment is filtered for nothing.
    if (!dst.vismap.initialized()) {
        dst.map.clear();
        if (!make_input(images, *plan.images().vismap, {}, plan.recipe(), "vismap", plan.recipe().vismap, options,
                        error)
            || !check_map(images[0], plan, options, error))
            return false;
        dst.vismap = std::move(images[0]);
        dst.map = map;
    }
    dst.color = [recipe = plan.recipe(), images = plan.images(), output = plan.output()] {
        return conversions_of(recipe, images, output);
    };
    dst.finish = [output = plan.output(), no_suns = plan.no_suns_text(),
                  effects = switched_off(plan.given().effects, LightmapRecipe::kStage),
                  threads = options.threads](OIIO::ImageBuf& lightmap) {
        tag_no_suns(lightmap.specmod(), no_suns);
        output.apply(lightmap, threads);
        tag_effects(lightmap.specmod(), effects);
    };
    // Frames share the points of the mesh that rays start from.
    if (!plan.images().suns) {
        dst.suns = nullptr;
    } else if (!dst.suns) {
        dst.suns = std::make_shared<LightmapSuns>(LightmapSuns { {}, plan.images().suns });
        dst.light.clear();
    } else if (dst.suns->shading->key() != plan.images().suns->key() || dst.suns->shading->failed()) {
        dst.suns->shading = plan.images().suns;
    }
    // What is traced is kept, unless that failed: the work may have been stopped.
    if (!plan.images().bounce || !dst.bounce || dst.bounce->key() != plan.images().bounce->key()
        || dst.bounce->failed())
        dst.bounce = plan.images().bounce;
    if (!make_light(dst, plan, options, error))
        return false;
    if (!plan.images().albedo || dst.albedo.initialized())
        return true;
    dst.texture = texture;
    if (!make_input(images, *plan.images().albedo, {}, plan.recipe(), "albedo", plan.recipe().albedo, options, error))
        return false;
    dst.albedo = std::move(images[0]);
    return true;
}

bool make_lightmap_image(OIIO::ImageBuf& lightmap, const LightmapPlan& plan, const MakeOptions& options,
                         std::string& error)
{
    LightmapInputs inputs;
    if (!make_lightmap_inputs(inputs, plan, options, error)
        || ((options.explain || plan.given().effects != "auto")
            && !explain_light(inputs, { plan.given(), plan.given().lightmap_params, plan.recipe().lightmap_params },
                              options, error)))
        return false;
    const Stopwatch timer;
    if (!make_lightmap(lightmap, inputs, plan.recipe().lightmap_params, options, error))
        return false;
    tag_udim(lightmap.specmod(), plan.recipe().udim);
    options.report(format("light: 1 map of {}x{} in {:.3f} s", plan.spec().width, plan.spec().height, timer()));
    return true;
}

} // namespace vmlight
