// SPDX-License-Identifier: Apache-2.0
#include "effects.h"
#include "gnuplot.h"
#include "live_page.h"
#include "report.h"
#include "write_report.h"

#include <vmlight/base/text_format.h>
#include <vmlight/cli/environment_options.h>
#include <vmlight/cli/main.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

using namespace vmlight;
using namespace vmlight::cost;

int main(int argc, const char** argv)
{
    CostParams params;
    VismapRecipe mesh;
    CfemRecipe light;
    StageMain stage("vmcost", "measure accuracy against time, and recommend settings", { "MESH", "ENVIRONMENT..." },
                    "  vmcost hero.obj studio.hdr -o report\n"
                    "  vmcost hero.obj studio.hdr sky.hdr --occluder ground.obj -o report\n"
                    "  vmcost hero.obj studio.hdr --quick -o report\n"
                    "An interrupted run resumes where it stopped.",
                    OutputKind::Folder);
    stage.params("Measure:", params);
    stage.params("Mesh:", mesh.selection);
    stage.params("Mesh:", mesh.mesh_params);
    stage.params("Mesh:", mesh.cutout_params);
    stage.group("Inputs:");
    stage.option("occluder", "FILE", "Mesh that occludes but is not baked; may be repeated", [&](auto text, auto&) {
        mesh.occluder.emplace_back(text);
        return true;
    });
    stage.option("normal_map", "FILE", "Normal map, for the table of effects alone: all else has the mesh's normals",
                 mesh.normal_map);
    stage.params("Inputs:", mesh.normal_map_params);
    add_environment_options(stage, light);
    stage.unused([&](const std::string& name) {
        const bool of_normal_map = OIIO::Strutil::starts_with(name, "normal_map_");
        return std::string(name == "ground_height" && !params.ground      ? "no ground is given"
                               : of_normal_map && mesh.normal_map.empty() ? "no normal map is given"
                                                                          : "");
    });

    return stage.run(argc, argv, [&](std::string& error) {
        const std::vector<std::string>& operands = stage.operands();
        const std::string& folder = stage.output();
        const MakeOptions options = stage.make_options();
        Inputs inputs;
        Measured measured;
        std::vector<EffectCost> effects;
        std::string live_page;
        mesh.mesh = operands[0];
        params.set_scene(mesh.vismap_params);
        const CommandInputs commands { mesh, operands[1], light, params.sanitize };
        error = params.no_plots ? "" : gnuplot_fault();
        if (!error.empty()
            || !read_inputs(inputs, mesh, { operands.begin() + 1, operands.end() }, light, options, error))
            return false;
        if (!OIIO::Filesystem::is_directory(folder) && !OIIO::Filesystem::create_directory(folder, error)) {
            error = "\"" + folder + "\": " + error;
            return false;
        }
        const std::vector<Setting> settings = sweep(params.quick);
        const size_t environments = inputs.environments.size();
        double total = double(environments) * reference_weight(params.pairs());
        for (const Setting& setting : settings)
            total += weight_of(setting, environments);
        const double page_weight = weight_of(default_setting("lobe"), environments);
        total += effects_weight(environments) + page_weight;
        const int64_t pictures = int64_t(settings.size() * environments + environments);
        WholeProgress progress(options.progress("measure", pictures * params.side() * params.side()), total);
        if (!trace_references(inputs, params, folder, options, progress, error)
            || !measure(measured, settings, inputs, params, folder, options, progress, error)
            || !measure_effects(effects, inputs, mesh, params, options, progress.part(effects_weight(environments)),
                                error)
            || !make_live_page(live_page, inputs, light, params, options, progress.part(page_weight), error))
            return false;
        progress.finish();
        if (!write_report(measured, effects, inputs, params, commands, live_page, folder, options, error))
            return false;
        options.say("measured " + count_text(measured.measured, "row", "rows") + ", reused "
                    + std::to_string(measured.reused));
        for (const std::string& line : choice_lines(summarize(measured.rows), commands))
            options.say(line);
        const std::string busy = busy_note(typical_spread(measured.rows));
        if (!busy.empty())
            options.report_warning(busy);
        options.say("report: " + folder + "/report.html");
        return true;
    });
}
