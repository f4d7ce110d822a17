// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/output_file.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/cli/main.h>
#include <vmlight/cli/mesh_part_names.h>
#include <vmlight/cli/part_run.h>
#include <vmlight/cli/pose_list.h>
#include <vmlight/cli/udim_run.h>
#include <vmlight/mesh/export/write_mesh.h>
#include <vmlight/stage/forecast_costs.h>
#include <vmlight/stage/large_map.h>
#include <vmlight/stage/mesh_list.h>
#include <vmlight/stage/pose_report.h>
#include <vmlight/stage/recipe/strand_recipe.h>
#include <vmlight/stage/strand_files.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/vismap/basis.h>
#include <vmlight/vismap/pose_sequence.h>

#include <set>
#include <string>

using namespace vmlight;

int main(int argc, const char** argv)
{
    VismapRecipe recipe;
    StageMain stage("makevismap", "bake a visibility map: how much each texel of a mesh sees, and where", { "MESH" },
                    "  makevismap hero.obj -o hero_vismap.exr --resolution 2048 --samples 256\n"
                    "  makevismap hero.obj -o 'hero_vismap.<UDIM>.exr'\n"
                    "  makevismap hero.glb --occluder ground.obj --occluder tree.ply -o hero_vismap.exr\n"
                    "  makevismap hero.glb --list\n"
                    "  makevismap hero.glb --material Body --material Face -o hero_vismap.exr\n"
                    "  makevismap hero.glb -o 'hero_<MATERIAL>.exr'\n"
                    "  makevismap village.toml -o 'village_<INSTANCE>.exr'\n"
                    "  makevismap scan.ply --unwrap --write-mesh scan_uv.glb -o scan_vismap.exr\n"
                    "  makevismap 'walk.####.obj' --frames 1-24 -o 'walk_vismap.####.exr'\n"
                    "  makevismap hero.obj --pose hero_bent.obj -o hero_vismap.exr\n"
                    "  makevismap hero.obj --part 3/16 -o hero_vismap.exr\n"
                    "  makevismap --join hero_vismap.part*of16.exr -o hero_vismap.exr\n"
                    "  makevismap hero.glb --samples 256 --print-recipe > hero.vismap\n"
                    "  makevismap hero.vismap -o hero_vismap.exr");
    PoseList poses(stage, recipe);
    UdimRun tiles(stage, recipe);
    PartRun parts(stage, recipe, poses);
    stage.group("Effects:");
    bool explain = false;
    stage.option("explain", "",
                 "Print before the bake which effects it simulates, and why, and after it what each took",
                 [&](auto, auto&) { return explain = true; });
    stage.dry_run("Print the same with the expected time and memory, and bake nothing; -o may be left out");
    stage.option("ground", "[HEIGHT]",
                 "Let an endless horizontal plane at y = HEIGHT occlude; default: the lowest point of the "
                 "mesh. It is not in pictures: see vmframes --ground",
                 [&](OIIO::string_view text, std::string& error) {
                     recipe.vismap_params.ground = true;
                     return text == "true" || set_param(recipe, "ground_height", text, error);
                 });
    stage.params("Visibility:", recipe.vismap_params);
    stage.option("time_budget", "SECONDS",
                 advanced("Instead of a fixed count, trace as many rays as this machine can in this time, the "
                          "time to measure their error included"),
                 [&](OIIO::string_view text, std::string& error) {
                     if (parse_value(recipe.time_budget, text, Range { 1e-3, 1e6 }, error))
                         return true;
                     error = "time_budget: " + error;
                     return false;
                 });
    stage.group("Mesh:");
    stage.answer("list", "Print the UV sets, materials and nodes of the mesh, and make no image",
                 [&](std::string& text, std::string& error) { return list_mesh(text, recipe, error); });
    stage.params("Mesh:", recipe.selection);
    std::string write_path;
    stage.params("Mesh:", recipe.mesh_params);
    stage.params("Mesh:", recipe.cutout_params);
    stage.option("write_mesh", "PATH",
                 "Also write the mesh or strands as baked, with the UVs of the map, to this .glb or .obj", write_path);
    stage.params("Strands:", recipe.strand_params);
    const auto unsavable = [&] {
        return recipe.time_budget > 0    ? "--time-budget cannot be saved in a recipe: it depends on the machine"
            : !write_path.empty()        ? "--write-mesh cannot be saved in a recipe"
            : stage.is_dry_run()         ? "--dry-run cannot be saved in a recipe"
            : explain                    ? "--explain cannot be saved in a recipe"
            : !poses.unsavable().empty() ? poses.unsavable()
            : !parts.unsavable().empty() ? parts.unsavable()
                                         : tiles.unsavable();
    };
    stage.recipe(
        "Inputs:", recipe, [&](const auto& operands) { recipe.mesh = operands[0]; }, unsavable);

    stage.check([&] {
        const std::string& basis = recipe.vismap_params.basis;
        return stage.pixel_format() == "half" && find_basis(basis).whole_numbers
            ? "--format half: the basis " + basis + " stores integers that half cannot represent; use float"
            : std::string();
    });

    stage.check([&] {
        return explain && parts.is_given() ? "--explain counts what a whole bake takes: not with --part or --resume"
                                           : "";
    });

    stage.check([&] { return write_path.empty() ? "" : mesh_name_fault(write_path); });
    stage.check([&] {
        return !write_path.empty() && has_udim_pattern(recipe.mesh) && !has_udim_pattern(write_path)
            ? "--write-mesh: <UDIM> in the mesh's path needs <UDIM> in this one too: each tile has a mesh"
            : std::string();
    });

    stage.check([&] {
        return !write_path.empty() && poses.count() > 1
            ? "--write-mesh writes one mesh: not with several frames or poses"
            : "";
    });

    stage.check([&] {
        const MeshPartPattern* const of_output = mesh_part_pattern(stage.output());
        const MeshPartPattern* const pattern = of_output ? of_output : mesh_part_pattern(write_path);
        return !write_path.empty() && pattern
            ? format("--write-mesh writes one mesh: not with {}; bake and write each {} with {} NAME", pattern->text,
                     pattern->noun, pattern->flag)
            : std::string();
    });

    stage.check([&] {
        return recipe.unwrap && (poses.count() > 1 || !poses.compared(recipe).empty())
            ? "--unwrap would give each pose UVs of its own: unwrap the first with --write-mesh, give its UVs to all, "
              "and "
              "bake those"
            : "";
    });

    stage.check([&] {
        const char* const flag = explain                           ? "--explain"
            : stage.is_dry_run()                                   ? "--dry-run"
            : poses.count() > 1 || !poses.compared(recipe).empty() ? "--frames and --pose"
            : parts.is_given()                                     ? "--part and --resume"
            : has_udim_pattern(stage.output()) || mesh_part_pattern(stage.output())
            ? "-o with <UDIM>, <MATERIAL> or <INSTANCE>"
            : "";
        return *flag && bakes_strands(recipe) ? format("\"{}\" has strands: {} only work for meshes", recipe.mesh, flag)
                                              : std::string();
    });

    const auto make_and_write
        = [&](const VismapRecipe& one, const std::string& path, const MakeOptions& options, std::string& error) {
              if (is_large_map(one, options))
                  return write_large_map(one, path, stage.file_params(), options, error);
              OIIO::ImageBuf vismap;
              if (!make_image(vismap, one, options))
                  error = oiio::error_line(vismap);
              return error.empty() && stage.write(vismap, path, error);
          };

    std::string written; // one mesh for all tiles, unless each has its own
    Forecasts forecasts;
    const auto make = [&](const auto& tile, const auto& output, const MakeOptions& given, std::string& error) {
        MakeOptions options = given;
        options.explain = explain;
        options.dry_run = stage.is_dry_run();
        options.forecasts = &forecasts;
        options.half = stage.pixel_format() == "half";
        options.pose_count = int64_t(1 + poses.compared(tile).size());
        PoseSequence sequence(poses.error());
        if (poses.is_sequence()) {
            options.poses = &sequence;
            options.pose_count = int64_t(poses.count());
        }
        if (options.dry_run)
            return forecast_vismap(tile, options, error);
        const std::string path = udim_path(write_path, tile.vismap_params.udim);
        if (!path.empty() && !(error = output_file_fault(path)).empty())
            return false;
        PoseTimes times;
        if (const auto others = poses.compared(tile);
            !others.empty() && !report_pose_changes(tile, others, poses.error(), times, options, error))
            return false;
        // What holds for all poses is said once; what is wrong with one of them, then.
        std::set<std::string> said;
        const auto once = [&said](const auto& listener) {
            return [&said, listener](const std::string& line) {
                const bool is_of_pose = line.compare(0, 5, "pose:") == 0;
                if ((said.insert(line).second || is_of_pose) && listener)
                    listener(line);
            };
        };
        if (parts.is_given() && !parts.make(poses.at(tile, 0), poses.path(output, 0), options, error))
            return false;
        for (size_t i = 0; i < poses.count() && !parts.is_given(); ++i) {
            const Stopwatch timer;
            MakeOptions own = options;
            if (poses.is_sequence()) {
                own.pose = poses.name(i);
                own.explain = explain && i == 0;
                prefix_messages(own, own.pose + ": ");
                own.say = once(own.say);
                own.answer = once(own.answer);
                own.warn = once(own.warn);
            }
            if (!make_and_write(poses.at(tile, i), poses.path(output, i), own, error)) {
                if (poses.is_sequence())
                    error = own.pose + ": " + error;
                return false;
            }
            if (poses.is_sequence())
                times.add(own.pose, timer(), sequence.last());
        }
        if (explain)
            times.report(options);
        if (path == written)
            return true;
        written = path;
        Strands strands;
        std::vector<Imath::V2f> uvs;
        if (bakes_strands(tile))
            return read_strand_uvs(strands, uvs, tile, error) && write_strands(strands, uvs, path, error);
        return write_mesh((*options.scene)->mesh(), path, error);
    };
    return stage.run(argc, argv, [&](std::string& error) {
        if (stage.is_form())
            return parts.join(error);
        error = poses.missing_fault();
        const bool made = error.empty() && tiles.make_tiles(make, error);
        if (made)
            parts.remove_kept();
        if (const std::string all = forecasts.text(); made && !all.empty())
            stage.answer(all);
        return made;
    });
}
