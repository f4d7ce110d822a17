// SPDX-License-Identifier: Apache-2.0
/// The mesh of a view, or its strands, and strands beside it, with all that is traced of them.
#pragma once

#include <vmlight/frame/camera.h>
#include <vmlight/frame/frame_scene.h>
#include <vmlight/frame/strand_object.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/strand_scene.h>
#include <vmlight/trace/visible_surface.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight::view {

/// What is opened: a mesh, or strands, and strands beside it.
struct MeshRequest
{
    VismapRecipe recipe; ///< of the first; its radius and texels are those of all strands
    std::vector<std::string> beside; ///< files of strands
    Imath::C3f strand_color { 1, 1, 1 };
};

struct MeshAsset
{
    VismapRecipe recipe; ///< its `udim` is a tile that the mesh uses
    std::shared_ptr<const Mesh> mesh;
    bool is_unwrapped = false; ///< though the recipe did not ask for it
    std::vector<SurfaceMaterial> materials;
    std::vector<std::vector<Imath::V2f>> material_uvs; ///< as read_object_mesh() sets them
    BakeScenePointer scene; ///< for bakes and references; nullptr for strands
    StrandObject strands; ///< instead, if it is one of strands: `mesh` has no triangles then
    std::shared_ptr<const StrandScene> strand_scene; ///< for their bakes
    Imath::C3f strand_color { 1, 1, 1 };
    std::vector<std::shared_ptr<const MeshAsset>> beside; ///< strands; of what was opened alone
    // Of it and what is beside it.
    VisibleSurface surface; ///< for what is under the cursor
    Subject subject;

    bool is_strands() const { return strand_scene != nullptr; }
};
using MeshPointer = std::shared_ptr<const MeshAsset>;

/// The subject of pictures of `mesh` and what is beside it, turned.
Subject subject_of(const MeshAsset& mesh, const Rotation& pose);

/// Read what `request` names and build its ray-tracing scenes.
///
/// @param has_map      a map of the first is there: it must keep its UVs; else it may be unwrapped (read_object_mesh())
/// @param light_space  interop id of the space of light and materials
/// @returns nullptr, with the reason in `error`, if it cannot be read or baked.
MeshPointer read_mesh_asset(MeshRequest request, bool has_map, const std::string& light_space,
                            const std::string& colorconfig, const MakeOptions& options, std::string& error);

} // namespace vmlight::view
