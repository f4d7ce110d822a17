// SPDX-License-Identifier: Apache-2.0
/// What a frame shows and lights: meshes (LitObject) and strands (LitStrands).
#pragma once

#include <vmlight/frame/frame_scene.h>
#include <vmlight/frame/scene_light.h>
#include <vmlight/frame/traced_light.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/reference/reference.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imagebuf.h>

#include <map>
#include <string>
#include <vector>

namespace vmlight {

/// The model that traces the light instead of looking it up.
constexpr const char* kReferenceModel = "reference";

struct ObjectRecipe
{
    /// The mesh or strands, what is chosen of it, and how it is baked; `udim` has no effect: all tiles are baked.
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

class FrameObject
{
public:
    FrameObject() = default;
    virtual ~FrameObject() = default;
    FrameObject(const FrameObject&) = delete;
    FrameObject& operator=(const FrameObject&) = delete;

    /// Read it, and make what is missing to bake it. False, with the reason in `error`, if an input cannot be read.
    virtual bool open(const ObjectRecipe& recipe, const MakeOptions& options, std::string& error) = 0;
    /// Look the light up in another file from now on, of an object that was opened with one; warns once of one that may
    /// be an albedo. False, with the reason in `error`, if it cannot be opened or is no lightmap.
    bool show_texture(const std::string& name, const MakeOptions& options, std::string& error);

    /// Triangles, or Mesh::strands.
    const Mesh& mesh() const { return *m_surface.mesh; }
    const FrameSurface& surface() const { return m_surface; }
    FrameSurface& surface() { return m_surface; }

    /// What is in the way of its light besides its own mesh, and sends light back to it; before the first light().
    void set_occluders(std::vector<FrameSurface> occluders) { m_occluders = std::move(occluders); }

    /// Look up materials in the space of the light: see read_materials().
    virtual bool read_materials(const std::string& light_space, const std::string& colorconfig,
                                const MakeOptions& options, std::string& error)
        = 0;

    /// Light it with a model, `auto` or kReferenceModel: bakes or reads the maps that the model needs, unless an
    /// earlier call did.
    ///
    /// @param used     nullptr, or set to the model that was used
    /// @returns false, with the reason in `error`, as make_lightmap() or make_reference() would
    virtual bool light(const SceneLight& light, const LightmapParams& params, const ReferenceParams& reference,
                       const MakeOptions& options, std::string& error, std::string* used = nullptr)
        = 0;

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

protected:
    /// How much of each texel is covered; empty: all of it.
    virtual const std::vector<float>& weights(int udim, const OIIO::ImageBuf& map, int nthreads) = 0;
    /// Look up light in the image of a tile. False, with the reason in `error`, if it has no colour.
    bool show_light(int udim, const OIIO::ImageBuf& lightmap, int nthreads, std::string& error);

    ObjectRecipe m_recipe;
    FrameSurface m_surface;
    std::vector<FrameSurface> m_occluders;
    std::map<std::string, TileMaps> m_maps; ///< by basis
    std::string m_basis;
    TileMaps m_lightmaps;
    bool m_is_unwrapped = false;
    double m_light_seconds = 0;

private:
    TexturePyramid pyramid(int udim, const OIIO::ImageBuf& map, int channels, const float* pixels, int nthreads);

    std::shared_ptr<TileTexture> m_light;
    bool m_warned_of_texture = false;
};

/// The basis to bake for a model, if `asked` leaves it open.
std::string basis_for(const std::string& model, const std::string& asked);

/// An object of the kind that the file of the recipe holds.
std::unique_ptr<FrameObject> make_frame_object(const ObjectRecipe& recipe);

} // namespace vmlight
