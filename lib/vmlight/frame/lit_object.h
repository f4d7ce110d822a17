// SPDX-License-Identifier: Apache-2.0
/// An object of a frame: its mesh, the visibility maps that light needs, and its light, remade for each rotation.
#pragma once

#include <vmlight/frame/frame_scene.h>
#include <vmlight/frame/scene_light.h>
#include <vmlight/frame/traced_light.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/reference/reference.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/trace/bake_scene.h>

#include <OpenImageIO/imagebuf.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// The model that traces the light instead of looking it up.
constexpr const char* kReferenceModel = "reference";

struct ObjectRecipe
{
    /// The mesh, what is chosen of it, and how it is baked; `udim` has no effect: all tiles are baked.
    VismapRecipe map;
    /// Visibility maps that are there: a file or recipe, with `<UDIM>` if there are several; "" to bake them.
    std::string vismap;
    /// Light that is there: looked up as it is, and no map is needed; "" for none. A sequence, with #, is opened by
    /// show_texture() only.
    std::string texture;
    /// What is traced of its light besides.
    TraceParams trace;
};

/// The visibility maps of an object, by UDIM tile.
using TileMaps = std::map<int, OIIO::ImageBuf>;

class LitObject
{
public:
    /// Read the mesh. One without UVs, or whose UVs overlap so heavily that they cannot have been made for baking, is
    /// unwrapped, and that is reported; a mesh whose map is given keeps its own.
    ///
    /// @returns false, with the reason in `error`, if an input cannot be read
    bool open(const ObjectRecipe& recipe, const MakeOptions& options, std::string& error);
    /// Look the light up in another file from now on, of an object that was opened with one. False, with the reason in
    /// `error`, if it cannot be opened.
    bool show_texture(const std::string& name, std::string& error);
    /// A mesh in memory, with UVs.
    void open(std::shared_ptr<const Mesh> mesh, const VismapParams& params, const TraceParams& trace = {});

    const Mesh& mesh() const { return *m_mesh; }
    const FrameSurface& surface() const { return m_surface; }
    FrameSurface& surface() { return m_surface; }

    /// What is in the way of its light besides its own mesh, and sends light back to it; before the first light().
    void set_occluders(std::vector<FrameSurface> occluders) { m_occluders = std::move(occluders); }

    /// Look up materials in the space of the light: see read_materials().
    bool read_materials(const std::string& light_space, const std::string& colorconfig, const MakeOptions& options,
                        std::string& error);

    /// Light the object with a model, `auto` or kReferenceModel: bakes or reads the maps that the model needs, unless
    /// an earlier call did. Suns and the bounce are traced on the object and its occluders, whatever a map that was
    /// read was baked with. The reference has the environment's own suns, and the bounce of a white object among white
    /// ones only.
    ///
    /// @param used     nullptr, or set to the model that was used
    /// @returns false, with the reason in `error`, as make_lightmap() or make_reference() would
    bool light(const SceneLight& light, const LightmapParams& params, const ReferenceParams& reference,
               const MakeOptions& options, std::string& error, std::string* used = nullptr);

    /// Seconds that light() took so far, without baking.
    double light_seconds() const { return m_light_seconds; }
    /// Whether open() made the mesh's UVs.
    bool is_unwrapped() const { return m_is_unwrapped; }
    /// Whether light() has used maps.
    bool has_maps() const { return m_maps.count(m_basis) != 0; }
    /// The maps that a model's light is of, and that light, by UDIM tile; after light().
    const TileMaps& maps() const { return m_maps.at(m_basis); }
    const TileMaps& lightmaps() const { return m_lightmaps; }

    /// Set the visibility that layers look up; after light().
    void show_visibility(int nthreads);

private:
    bool prepare_scene(const MakeOptions& options, std::string& error);
    bool prepare_maps(const std::string& model, const MakeOptions& options, std::string& error);
    bool read_maps(const MakeOptions& options, std::string& error);
    bool bake_maps(TileMaps& dst, const std::string& basis, const MakeOptions& options, std::string& error);
    const std::vector<float>& weights(int udim, const OIIO::ImageBuf& map, int nthreads);
    bool light_tile(OIIO::ImageBuf& dst, int udim, const OIIO::ImageBuf& map, const SceneLight& light,
                    const LightmapParams& params, const MakeOptions& options, std::string& error);
    bool trace_tile(OIIO::ImageBuf& dst, int udim, const OIIO::ImageBuf& map, const SceneLight& light,
                    const LightmapParams& params, const ReferenceParams& reference, const MakeOptions& options,
                    std::string& error);

    ObjectRecipe m_recipe;
    std::shared_ptr<const Mesh> m_mesh;
    std::vector<FrameSurface> m_occluders;
    BakeScenePointer m_scene;
    std::map<std::string, TileMaps> m_maps; // by basis
    std::string m_basis;
    std::map<std::string, std::map<int, std::unique_ptr<TracedLight>>> m_traced; // by basis and tile
    TileMaps m_lightmaps;
    std::map<int, std::vector<float>> m_weights;
    std::shared_ptr<TileTexture> m_light;
    FrameSurface m_surface;
    bool m_is_unwrapped = false;
    double m_light_seconds = 0;
};

} // namespace vmlight
