// SPDX-License-Identifier: Apache-2.0
/// Everything that is on the graphics card, and the passes that make a picture of it: relight in texture space, only
/// when light, rotation, model or map changed; then draw.
#pragma once

#include "../draw/draw_pass.h"
#include "../draw/mesh_buffers.h"
#include "../relight/relight_pass.h"
#include "../scene/assets.h"

#include <vmlight/lightmap/lightmap.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace vmlight::view {

/// What a picture shows besides the lit textures.
struct PictureParams
{
    View view;
    bool has_background = false;
    Rotation to_environment; ///< of the background
    Show show = Show::lit;
    /// Where the second texture begins, as a share of the width; 1 and more: nowhere.
    double wipe = 1;
};

class Renderer
{
public:
    /// Compile the shaders. False, with the reason in `error`, if the driver refuses one.
    bool build(std::string& error);

    // What there is; nullptr takes it away. False, with the reason in `error`, if the driver has no room for it.
    bool set_mesh(MeshPointer mesh, bool with_materials, std::string& error);
    bool set_map(MapPointer map, std::string& error);
    bool set_light(LightPointer light, std::string& error);
    const MeshPointer& mesh() const { return m_mesh; }
    const MapPointer& map() const { return m_map; }
    const LightPointer& light() const { return m_light; }

    /// Light the map into texture number `slot`, 0 or 1, on the graphics card. `params` as for RelightPass::run().
    bool relight(int slot, const LightmapParams& params, std::string& error);
    /// Take three floats a texel instead, of the map's size; with `adds`, what add_light() gave is added.
    void set_texture(int slot, const float* rgb, bool adds = false);
    /// Add light, three floats a texel of the map's size, to the next relight() of a slot and those after it, until
    /// there is no map or one of another size; nothing if it is empty.
    void add_light(int slot, std::vector<float> rgb);
    bool has_added() const { return !m_added[0].empty() || !m_added[1].empty(); }
    bool has_texture(int slot) const { return bool(m_lit[size_t(slot)].texture()); }
    /// R, G, B of a texture, times weight, and the weight.
    std::vector<float> read_texture(int slot) const { return m_lit[size_t(slot)].read(); }

    /// The same of one texel.
    void read_texel(int slot, int x, int y, float* rgba) const
    {
        m_lit[size_t(slot)].level(0).read_rect(x, y, 1, 1, rgba);
    }

    /// Prepare pictures of `view`, whatever its offset, that are right at every edge, to float's precision, unless the
    /// mesh is too large for the driver (millions of triangles); draw() then makes such until reset_exact().
    void prepare_exact(const View& view);
    void reset_exact()
    {
        m_exact = ExactMesh();
        m_is_exact = false;
    }

    /// Draw one sample of each pixel into `target`, of the view's size with a depth buffer.
    void draw(const PictureParams& params, const Framebuffer& target) const;
    /// Add `share` of one picture to another.
    void accumulate(const Framebuffer& sum, const Texture& picture, double share) const;

private:
    void bind_no_vertices() const;
    const std::vector<SurfaceMaterial>& materials() const;

    VertexArray m_no_vertices;
    RelightPass m_relight;
    DrawPass m_draw;
    MeshPointer m_mesh;
    MapPointer m_map;
    LightPointer m_light;
    std::unique_ptr<MeshBuffers> m_buffers;
    MaterialTextures m_materials;
    ExactMesh m_exact;
    bool m_has_materials = true, m_is_exact = false;
    MapTextures m_map_textures;
    LightTextures m_light_textures;
    LitTexture m_panorama;
    std::array<LitTexture, 2> m_lit;
    std::array<std::vector<float>, 2> m_added;
    std::array<Texture, 2> m_added_textures; // the same
};

} // namespace vmlight::view
