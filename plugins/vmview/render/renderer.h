// SPDX-License-Identifier: Apache-2.0
/// Everything that is on the graphics card, and the passes that make a picture of it: relight in texture space, only
/// when light, rotation, model or map changed; then draw.
#pragma once

#include "../scene/added_light.h"
#include "figure.h"

#include <vmlight/lightmap/lightmap.h>

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

/// The mesh, or strands, that was opened is figure 0; strands beside it follow.
class Renderer
{
public:
    /// Compile the shaders. False, with the reason in `error`, if the driver refuses one.
    bool build(std::string& error);

    // What there is, with what is beside it; nullptr takes it away. False, with the reason in `error`, if the driver
    // has no room for it.
    bool set_mesh(MeshPointer mesh, bool with_materials, std::string& error);
    bool set_map(MapPointer map, std::string& error);
    bool set_light(LightPointer light, std::string& error);
    const MeshPointer& mesh(size_t figure = 0) const { return figure < figures() ? at(figure).mesh() : m_no_mesh; }
    const MapPointer& map(size_t figure = 0) const { return figure < figures() ? at(figure).map() : m_no_map; }
    const LightPointer& light() const { return m_light; }
    size_t figures() const { return m_figures.size(); }

    /// Light the map of a figure into its texture number `slot`, 0 or 1, on the graphics card. `params` as for
    /// RelightPass::run().
    bool relight(int slot, const LightmapParams& params, std::string& error, size_t figure = 0);
    /// Take three floats a texel instead, of the map's size; with `adds`, what add_light() gave is added.
    void set_texture(int slot, const float* rgb, bool adds = false, size_t figure = 0);
    /// Add light, for each figure, to the next relight() of a slot and those after it, until there is no map or one of
    /// another size; nothing if it is empty.
    void add_light(int slot, AddedTexels rgb);
    bool has_added() const;
    bool has_texture(int slot) const { return figures() > 0 && bool(at(0).lit(slot).texture()); }
    /// R, G, B of a texture, times weight, and the weight.
    std::vector<float> read_texture(int slot, size_t figure = 0) const { return at(figure).lit(slot).read(); }

    /// The same of one texel.
    void read_texel(int slot, int x, int y, float* rgba, size_t figure = 0) const
    {
        at(figure).lit(slot).level(0).read_rect(x, y, 1, 1, rgba);
    }

    /// Prepare pictures of `view`, whatever its offset, that are right at every edge, to float's precision, unless the
    /// mesh is too large for the driver (millions of triangles); draw() then makes such until reset_exact().
    void prepare_exact(const View& view);
    void reset_exact();

    /// Draw one sample of each pixel into `target`, of the view's size with a depth buffer.
    void draw(const PictureParams& params, const Framebuffer& target) const;
    /// Add `share` of one picture to another.
    void accumulate(const Framebuffer& sum, const Texture& picture, double share) const;

private:
    void bind_no_vertices() const;
    const Figure& at(size_t figure) const { return m_figures[figure]; }
    void draw_figures(int slot, const PictureParams& params, int first, int end) const;
    bool filter_for_strands(std::string& error);

    const MeshPointer m_no_mesh;
    const MapPointer m_no_map;
    VertexArray m_no_vertices;
    RelightPass m_relight;
    DrawPass m_draw;
    StrandPass m_strands;
    std::vector<Figure> m_figures;
    LightPointer m_light;
    bool m_is_exact = false;
    LightTextures m_light_textures, m_strand_light; // the latter made when it is first needed
    LitTexture m_panorama;
    Texture m_cones;
};

} // namespace vmlight::view
