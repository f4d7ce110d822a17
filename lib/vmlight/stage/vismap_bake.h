// SPDX-License-Identifier: Apache-2.0
/// What an executable does with a recipe of a mesh: bake the whole map, rows or parts of it, or say what that would
/// take.
#pragma once

#include <vmlight/stage/bake_forecast.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/map_parts.h>
#include <vmlight/stage/scene_cache.h>
#include <vmlight/vismap/make_map.h>
#include <vmlight/vismap/map_rows.h>

#include <OpenImageIO/imagebuf.h>

#include <memory>
#include <string>

namespace vmlight {

class VismapBake
{
public:
    /// @param recipe   resolved to one UDIM tile, and without faults
    VismapBake(const VismapRecipe& recipe, SceneStamps stamps);

    const VismapRecipe& given() const { return m_given; }
    /// With its switches applied.
    const VismapRecipe& recipe() const { return m_recipe; }
    const SceneStamps& stamps() const { return m_stamps; }
    /// Of the map, as far as it is known before the mesh is read: without its hash.
    const OIIO::ImageSpec& spec() const { return m_spec; }

    /// The whole map in one go: no tile cache, no overlapping margins.
    bool make(OIIO::ImageBuf& map, const MakeOptions& options, std::string& error) const;
    /// The map from the top down.
    bool stream(const MapRows& rows, const MakeOptions& options, std::string& error) const;
    /// Some parts of the map.
    bool make_parts(const PartRequest& request, const MakeOptions& options, std::string& error) const;
    /// Report what make() would do, and take.
    bool report_plan(const MakeOptions& options, std::string& error) const;
    /// Decide which effects the scene calls for.
    bool forecast_effects(BakeForecast& dst, const BakeScenePointer& scene, const NormalMapPointer& normal_map,
                          const MakeOptions& options, std::string& error) const;

private:
    struct Inputs;
    bool read_scene(BakeScenePointer& dst, double* built, const MakeOptions& options, std::string& error) const;
    bool read_inputs(Inputs& dst, const MakeOptions& options, std::string& error) const;
    MapJob job_of(const Inputs& inputs, const MakeOptions& options) const;
    void tag(OIIO::ImageSpec& map, const BakeScene& scene) const;
    void report(const Inputs& inputs, VismapReport& report, const OIIO::ImageSpec& map,
                const MakeOptions& options) const;

    const VismapRecipe m_given, m_recipe;
    const SceneStamps m_stamps;
    OIIO::ImageSpec m_spec;
};

/// The mesh of a scene, which it keeps alive.
inline std::shared_ptr<const Mesh> mesh_of(const BakeScenePointer& scene)
{
    return { scene, &scene->mesh() };
}

} // namespace vmlight
