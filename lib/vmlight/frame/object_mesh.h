// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight {

struct ObjectMesh
{
    std::shared_ptr<Mesh> mesh;
    bool is_unwrapped = false;
    /// The UVs that materials ask for, where they are not those of the mesh: for each UV set three a triangle, or
    /// nothing.
    std::vector<std::vector<Imath::V2f>> material_uvs;
};

/// Read the mesh of a frame's object: what `recipe` chooses of its file, with UVs that light can be looked up by.
///
/// @param may_unwrap       whether a mesh without UVs, or with UVs that overlap too heavily to be baked, gets an atlas;
///                         reported if so
/// @returns false, with the reason in `error`, if it cannot be read, or has no UVs and may not be unwrapped
bool read_object_mesh(ObjectMesh& dst, const VismapRecipe& recipe, bool may_unwrap, const MakeOptions& options,
                      std::string& error);

/// Warn if the visibility map `map`, of the file `vismap`, was baked from another mesh, or with another of its UV sets.
/// It may still be meant: the mesh may have been changed since.
///
/// @param uv_set   that was read
void warn_of_other_mesh(const Mesh& mesh, int uv_set, const OIIO::ImageSpec& map, const std::string& vismap,
                        const MakeOptions& options);

} // namespace vmlight
