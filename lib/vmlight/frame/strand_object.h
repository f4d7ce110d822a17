// SPDX-License-Identifier: Apache-2.0
/// Strands as an object of a picture: where they are in their visibility map, and that map.
#pragma once

#include <vmlight/frame/strand_surface.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/trace/strand_scene.h>
#include <vmlight/vismap/strand_map.h>

#include <OpenImageIO/imagebuf.h>

#include <memory>
#include <string>

namespace vmlight {

struct StrandObject
{
    std::shared_ptr<const Mesh> mesh; ///< without triangles: Mesh::strands
    StrandLayout layout;
    std::shared_ptr<const StrandSurface> surface;

    const Strands& strands() const { return *mesh->strands; }

    /// Read the strands of a recipe, with its radius. False, with the reason in `error`, if they cannot be baked.
    bool open(const VismapRecipe& recipe, std::string& error);
};

/// Read their map, or make it from its recipe. False, with the reason in `error`, if it is not that of as many strands.
bool read_strand_map(OIIO::ImageBuf& dst, const StrandObject& object, const std::string& path,
                     const MakeOptions& options, std::string& error);

/// Bake their map, and report it.
///
/// @param scene    of these strands
/// @param recipe   theirs; its basis is that of the map
/// @returns false, with the reason in `error`: "interrupted" if it was stopped
bool bake_strand_map(OIIO::ImageBuf& dst, const StrandObject& object, const StrandScene& scene,
                     const VismapRecipe& recipe, const MakeOptions& options, std::string& error);

} // namespace vmlight
