// SPDX-License-Identifier: Apache-2.0
#include "mesh_asset.h"

#include <vmlight/base/format.h>
#include <vmlight/frame/object_mesh.h>
#include <vmlight/frame/surface_materials.h>
#include <vmlight/stage/recipe/strand_recipe.h>
#include <vmlight/uv/udim.h>

#include <utility>

namespace vmlight::view {
namespace {

bool open_mesh(MeshAsset& dst, bool has_map, const std::string& light_space, const std::string& colorconfig,
               const MakeOptions& options, std::string& error)
{
    ObjectMesh object;
    if (!read_object_mesh(object, dst.recipe, !has_map, options, error))
        return false;
    const std::vector<int> tiles = mesh_udims(*object.mesh);
    if (!dst.recipe.udim_given && !tiles.empty()) {
        const int udim = tiles[0];
        dst.recipe.vismap_params.udim = udim;
        if (tiles.size() > 1)
            options.report_warning(
                format("\"{}\": UVs in {} UDIM tiles, {} to {}, of which {} alone is lit; --udim chooses "
                       "another",
                       dst.recipe.mesh, tiles.size(), udim, tiles.back(), udim));
    }
    dst.is_unwrapped = object.is_unwrapped;
    dst.material_uvs = std::move(object.material_uvs);
    dst.mesh = std::move(object.mesh);
    return read_materials(dst.materials, *dst.mesh, light_space, colorconfig, options, error);
}

bool open_strands(MeshAsset& dst, std::string& error)
{
    if (!dst.strands.open(dst.recipe, error))
        return false;
    dst.mesh = dst.strands.mesh;
    return true;
}

// All of `others` are in the way of its light.
bool build_scene(MeshAsset& dst, const std::vector<Mesh>& others, int threads, std::string& error)
{
    if (dst.strands.mesh) {
        auto scene = std::make_shared<StrandScene>();
        if (!scene->build(dst.strands.strands(), others, threads, error))
            return false;
        dst.strand_scene = std::move(scene);
        return true;
    }
    auto scene = std::make_shared<BakeScene>();
    SceneChoice choice;
    choice.cull = others.empty(); // a bounce may be switched on later, which occluders shade that no texel sees
    if (!scene->build(dst.mesh, others, threads, error, choice))
        return false;
    dst.scene = std::move(scene);
    return true;
}

} // namespace

Subject subject_of(const MeshAsset& mesh, const Rotation& pose)
{
    Subject subject;
    subject.add(*mesh.mesh, pose);
    for (const MeshPointer& other : mesh.beside)
        subject.add(*other->mesh, pose);
    return subject;
}

MeshPointer read_mesh_asset(MeshRequest request, bool has_map, const std::string& light_space,
                            const std::string& colorconfig, const MakeOptions& options, std::string& error)
{
    std::vector<std::shared_ptr<MeshAsset>> all { std::make_shared<MeshAsset>() };
    all[0]->recipe = request.recipe;
    for (const std::string& path : request.beside) {
        if (!is_strand_occluder(request.recipe, path)) {
            error = format("--object: \"{}\" is no file of strands; only they can be beside MESH", path);
            return nullptr;
        }
        all.push_back(std::make_shared<MeshAsset>());
        all.back()->recipe = request.recipe;
        all.back()->recipe.mesh = path;
    }
    std::vector<const Mesh*> meshes;
    for (const auto& asset : all) {
        asset->strand_color = request.strand_color;
        const bool is_strands = asset != all[0] || is_strand_occluder(request.recipe, request.recipe.mesh);
        if (!(is_strands ? open_strands(*asset, error)
                         : open_mesh(*asset, has_map, light_space, colorconfig, options, error)))
            return nullptr;
        meshes.push_back(asset->mesh.get());
    }
    for (size_t i = 0; i < all.size(); ++i) {
        std::vector<Mesh> others;
        for (size_t k = 0; k < all.size(); ++k)
            if (k != i)
                others.push_back(*meshes[k]);
        if (!build_scene(*all[i], others, options.threads, error))
            return nullptr;
    }
    MeshAsset& first = *all[0];
    first.beside.assign(all.begin() + 1, all.end());
    first.subject = subject_of(first, {});
    for (size_t i = 1; i < all.size(); ++i)
        all[i]->subject = first.subject;
    const SceneFrame& frame = first.is_strands() ? first.strand_scene->frame() : first.scene->frame();
    return first.surface.build(meshes, frame, options.threads, error) ? all[0] : nullptr;
}

} // namespace vmlight::view
