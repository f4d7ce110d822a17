// SPDX-License-Identifier: Apache-2.0
/// The meshes that a visibility map was baked from, found again to trace light on its texels.
#pragma once

#include <vmlight/base/once_cache.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/chain.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/stage/scene_cache.h>
#include <vmlight/vismap/normal_map.h>

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

namespace vmlight {

/// The bake that `map` says it is from, but for the meshes. Keys that are not in the map, or are no longer valid, keep
/// their defaults.
VismapRecipe recipe_of_map(const OIIO::ImageSpec& map);

class MapScene
{
public:
    /// A scene that is built already, whose mesh has the texels of the map: prepare() has nothing to do. Without a
    /// normal map.
    ///
    /// @param vismap   the header of the map, all of which is there
    /// @param udim     its tile
    static std::shared_ptr<MapScene> of(BakeScenePointer scene, const OIIO::ImageSpec& vismap, int udim);

    /// Find the meshes: those of the recipe of the visibility map, or the recipe's own `mesh` and `occluder`, read as
    /// the metadata of the map say. Reads no mesh.
    ///
    /// @param recipe   with its UDIM tile resolved
    /// @param vismap   the header of the visibility map
    /// @param from_anywhere    rays will start at occluders too: none is left out because no texel can see it
    /// @returns nullptr, with the location and reason in `error`, if a file is missing, or the map is only a part of
    ///          one
    static std::shared_ptr<MapScene> open(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap,
                                          bool from_anywhere, std::string& error, const RecipeChain& chain);

    /// Whether there is a mesh: a file of a map does not say where its own is.
    bool has_mesh() const { return !m_mesh.mesh.empty(); }
    /// Equal keys, equal scenes and texels.
    const std::string& key() const { return m_key; }
    /// Pixels of the map.
    const OIIO::ROI& roi() const { return m_roi; }

    /// Read and build them, once. False, with the location and reason in `error`, if a mesh cannot be read or is not
    /// the one that was baked, or memory runs out.
    bool prepare(const MakeOptions& options, std::string& error);
    /// Whether that failed, or a file has changed since.
    bool failed() const { return m_prepare.failed() || (m_prepare.succeeded() && !are_unchanged(m_scene->files)); }

    /// After prepare().
    const BakeScenePointer& scene() const { return m_scene; }
    const NormalMapPointer& normal_map() const { return m_normals; }
    /// The bake, with the map's own size.
    const VismapParams& params() const { return m_map; }
    /// Before prepare(): what the meshes were when they were found; and the hash of the one that was baked, "" if it is
    /// not known.
    const SceneStamps& stamps() const { return m_stamps; }
    const std::string& mesh_hash() const { return m_hash; }
    /// What to do if the map was baked with occluders other than those of these hashes, after the map's name; or "".
    std::string occluder_fault(const std::string& hashes) const;
    /// The bake as it was asked for: its meshes, and how they are read.
    const VismapRecipe& recipe() const { return m_mesh; }

private:
    bool read(const MakeOptions& options, std::string& error);

    LightmapRecipe m_recipe;
    VismapRecipe m_mesh; ///< what to trace on
    VismapParams m_map; ///< its texels
    OIIO::ROI m_roi;
    std::string m_normal_map; ///< of a stored map that was baked with one
    std::string m_hash, m_occluder_hashes, m_occluder_names; ///< of the meshes that were baked; "" if unknown
    SceneStamps m_stamps;
    std::string m_key;
    RunOnce m_prepare;
    BakeScenePointer m_scene;
    NormalMapPointer m_normals;
};

} // namespace vmlight
