// SPDX-License-Identifier: Apache-2.0
/// What a view shows: a mesh or strands, its visibility map and an environment, read from files. Immutable once read,
/// so that background work may go on with what the view has replaced.
#pragma once

#include "mesh_asset.h"

#include <vmlight/frame/scene_light.h>
#include <vmlight/frame/strand_specular.h>
#include <vmlight/frame/texture_pyramid.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imagebuf.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight::view {

struct MapAsset
{
    std::string path; ///< "" if it was baked here
    int samples = 0; ///< rays per texel, if it was
    OIIO::ImageBuf image; ///< float, in memory
    std::vector<float> weights; ///< texel_weights(); of strands 1 for each of their texels
    std::vector<std::shared_ptr<const MapAsset>> beside; ///< of MeshAsset::beside, if they are there
};
using MapPointer = std::shared_ptr<const MapAsset>;

struct LightAsset
{
    std::string path;
    /// With the environment, unless `path` is a CFEM. Its filtered images may be lit without its suns, which are added
    /// once they are traced (scene/added_light.h).
    SceneLight light;
    std::shared_ptr<const ConeLevels> cones; ///< for the highlights of strands, or nullptr
    double specular = 0; ///< their strength
    std::shared_ptr<const TexturePyramid> panorama; ///< of the environment, or of what a stack keeps of it; or nullptr

    const std::vector<OIIO::ImageBuf>& filtered() const { return light.filtered; }
};
using LightPointer = std::shared_ptr<const LightAsset>;

/// Read a visibility map, or make it from its recipe, for the UDIM tile of `mesh`. nullptr, with the reason in `error`.
MapPointer read_map_asset(const std::string& path, const MeshAsset& mesh, const MakeOptions& options,
                          std::string& error);

/// The first half of it for meshes, which needs none: `path` has no <UDIM>.
bool read_map_image(OIIO::ImageBuf& dst, const std::string& path, const MakeOptions& options, std::string& error);

/// Take `image`, which was read from `path`, or baked with `samples` rays.
MapPointer make_map_asset(OIIO::ImageBuf image, const std::string& path, const MeshAsset& mesh, int threads);
MapPointer make_map_asset(OIIO::ImageBuf image, int samples, const MeshAsset& mesh, int threads);

/// Read an environment and filter it into a stack, or read a CFEM or stack.
///
/// @param recipe   colour space, layer, layout and filter, as for SceneLight::open()
/// @param blur     of the panorama, in degrees
/// @param specular of strands: highlights, if they have a strength
/// @returns nullptr, with the reason in `error`, if it cannot be read.
LightPointer read_light_asset(const std::string& path, CfemRecipe recipe, double blur, const SpecularParams& specular,
                              const MakeOptions& options, std::string& error);

/// What kind of file a name is, to tell what a user opens or drops.
enum class AssetKind
{
    none,
    mesh,
    map,
    light
};
/// By its contents where its extension leaves it open; files of strands are meshes here. `none`, with the reason in
/// `error`, if it is nothing to look at.
AssetKind kind_of_file(const std::string& path, std::string& error);

} // namespace vmlight::view
