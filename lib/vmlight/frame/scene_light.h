// SPDX-License-Identifier: Apache-2.0
/// The light of a frame: an environment, filtered once for all objects, models and rotations.
#pragma once

#include <vmlight/cfem/suns.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// How an environment becomes light.
struct SceneLight
{
    /// A CFEM or all images of a stack, for make_lightmap().
    std::vector<OIIO::ImageBuf> filtered;
    /// The environment itself in the working space, if it was asked for; not initialized if only a CFEM is known.
    OIIO::ImageBuf environment;
    /// Interop id of the working space.
    std::string space;

    /// The suns that were split off `filtered`, in the working space; none if it has its suns.
    std::vector<Sun> suns;

    /// Read and filter.
    ///
    /// @param name     a lat-long image, or a CFEM or stack, or the recipe of one
    /// @param recipe   colour space, layer and layout of the image, and how it is filtered: `stack` for models that
    ///                 read more than a CFEM; `suns` where they are traced. A CFEM without its suns is refused if they
    ///                 are not
    /// @param keep_environment     whether `environment` is needed
    /// @returns false, with the reason in `error`, if it cannot be read or filtered
    bool open(const std::string& name, CfemRecipe recipe, bool keep_environment, const MakeOptions& options,
              std::string& error);
};

/// The rotation of the object in the world, where the camera stands: that of `params` without the environment's. False,
/// with the reason in `error`, as lightmap_rotation().
bool object_pose(Rotation& dst, const LightmapParams& params, std::string& error);

/// The parameters of the light on an object that turns by `degrees` about y after its own rotation `pose`. Without
/// exposure, which is the picture's.
LightmapParams turned_light(const LightmapParams& params, const Rotation& pose, double degrees);

} // namespace vmlight
