// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/scene_files.h>

#include <vmlight/base/format.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/mesh/import/strands/read_strands.h>
#include <vmlight/mesh/instances.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/cutouts.h>
#include <vmlight/stage/recipe/strand_recipe.h>

#include <algorithm>
#include <functional>
#include <memory>

namespace vmlight {
namespace {

const std::string& path_of(const VismapRecipe& recipe, size_t index)
{
    return index ? recipe.occluder[index - 1] : recipe.mesh;
}

const char* key_of(size_t index)
{
    return index ? "occluder" : "mesh";
}

bool read_strand_occluder(Mesh& dst, const VismapRecipe& recipe, const std::string& path, const BeforeOpen& note,
                          std::string& error)
{
    auto strands = std::make_shared<Strands>();
    if (!read_strands(*strands, path, recipe.mesh_params, recipe.strand_params.radius, error, note))
        return false;
    dst = Mesh();
    dst.name = strands->name;
    dst.path = path;
    dst.strands = std::move(strands);
    return true;
}

} // namespace

UnwrapParams unwrap_params(const VismapRecipe& recipe, int nthreads)
{
    const Size size = recipe.vismap_params.size();
    return { size.width, size.height, recipe.vismap_params.margin, nthreads };
}

bool read_scene_file(Mesh& dst, std::vector<FileStamp>& files, const VismapRecipe& recipe, const SceneStamps& stamps,
                     size_t index, const StepListener& at_step, std::string& at, std::string& error)
{
    at = key_of(index);
    begin_step(at_step, "read");
    const std::string& mesh_path = path_of(recipe, index);
    ++work_counts().meshes_read;
    const auto note = [&](const std::string& path) { note_file(files, path); };
    if (index && is_strand_occluder(recipe, mesh_path))
        return read_strand_occluder(dst, recipe, mesh_path, note, error)
            && check_stamp(stamps.files[index], mesh_path, error);
    const auto read = index ? read_instanced_mesh : read_mesh;
    if (!read(dst, mesh_path, recipe.mesh_params, error, note) || !check_stamp(stamps.files[index], mesh_path, error))
        return false;
    if (recipe.cutout_params.cutouts == "off")
        return true;
    const auto read_again = [&](Mesh& again, int uv_set) {
        MeshParams params = recipe.mesh_params;
        params.uv_set = uv_set;
        std::string ignored;
        ++work_counts().meshes_read;
        return read(again, mesh_path, params, ignored, {});
    };
    const auto add_cutouts = [&](Mesh& mesh, bool loses_uvs, const std::function<bool(Mesh&, int)>& again) {
        if (std::any_of(mesh.materials.begin(), mesh.materials.end(),
                        [](const Material& material) { return material.alpha_mode != AlphaMode::opaque; }))
            begin_step(at_step, "read cut-outs");
        return read_cutouts(mesh, { recipe.mesh_params.uv_set, loses_uvs, again }, &files, error);
    };
    for (size_t i = 0; dst.instances && i < dst.instances->meshes.size(); ++i) {
        const auto read_distinct = [&](Mesh& again, int uv_set) {
            Mesh whole;
            if (!read_again(whole, uv_set) || !whole.instances || whole.instances->meshes.size() <= i)
                return false;
            again = std::move(whole.instances->meshes[i]);
            return true;
        };
        if (!add_cutouts(dst.instances->meshes[i], false, read_distinct))
            return false;
    }
    return add_cutouts(dst, recipe.unwrap && index == 0, read_again);
}

bool stamp_scene(SceneStamps& dst, const VismapRecipe& recipe, std::string& at, std::string& error)
{
    SceneStamps stamps;
    stamps.files.resize(1 + recipe.occluder.size());
    MeshParams params = recipe.mesh_params;
    params.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        stamps.key += std::string(name) + "=" + value_text(value, allowed) + "\n";
    });
    stamps.key += "cutouts=" + recipe.cutout_params.cutouts + "\nradius=" + recipe.strand_params.radius + "\n";
    if (recipe.unwrap) {
        const UnwrapParams atlas = unwrap_params(recipe, 0);
        stamps.key += format("unwrap={}x{},{}\n", atlas.width, atlas.height, atlas.margin);
    }
    // What is traced of them.
    const SceneChoice choice = scene_choice(recipe);
    stamps.key += format("traced={}{}{}{} {}\n", choice.self, choice.occluders, choice.cull,
                         choice.cutouts == CutoutMode::every_hit, choice.reach);
    for (size_t i = 0; i < stamps.files.size(); ++i) {
        at = key_of(i);
        if (!stamp_file(stamps.files[i], path_of(recipe, i), error))
            return false;
        stamps.key += stamps.files[i];
    }
    dst = std::move(stamps);
    return true;
}

} // namespace vmlight
