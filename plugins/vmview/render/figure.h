// SPDX-License-Identifier: Apache-2.0
/// One object on the graphics card: a mesh or strands, its visibility map, and the two textures that are lit of it.
#pragma once

#include "../draw/draw_pass.h"
#include "../draw/strand_pass.h"
#include "../relight/relight_pass.h"
#include "../scene/assets.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace vmlight::view {

class Figure
{
public:
    /// Load a mesh or strands. False, with the reason in `error`, if the driver has no room for it.
    bool load(MeshPointer mesh, bool with_materials, std::string& error);
    /// Load its map; nullptr takes it away. What was added to a map of the same size is kept: one that is baked step by
    /// step has more to come.
    bool set_map(MapPointer map, std::string& error);
    const MeshPointer& mesh() const { return m_mesh; }
    const MapPointer& map() const { return m_map; }
    const MapTextures& map_textures() const { return m_map_textures; }

    /// Light in texture space; two, for comparisons.
    LitTexture& lit(int slot) { return m_lit[size_t(slot)]; }
    const LitTexture& lit(int slot) const { return m_lit[size_t(slot)]; }
    /// Fill level 0 of a texture with three floats a texel; with `adds`, what add_light() gave is added.
    void fill(int slot, const float* rgb, bool adds);
    /// Light besides that of models, three floats a texel; empty: none.
    void add_light(int slot, std::vector<float> rgb);
    /// The same on the card; nullptr: none.
    const Texture* added(int slot) const;

    /// See Renderer::prepare_exact().
    void prepare_exact(const View& view, const Subject& all);
    void reset_exact() { m_exact = ExactMesh(); }
    bool has_exact_mesh() const { return !m_exact.is_empty(); }

    /// Draw it, in columns [`first`, `end`) only; strands need a vertex array bound, which may be empty.
    ///
    /// @param all      what is drawn besides it, too
    /// @param ribbons  how strands are drawn
    /// @param highlights   theirs, without the map
    void draw(const DrawPass& meshes, const StrandPass& strands, int slot, const Subject& all, Show show,
              RibbonMode ribbons, const Highlights& highlights, const View& view, int first, int end) const;

private:
    const std::vector<SurfaceMaterial>& materials() const;

    MeshPointer m_mesh;
    MapPointer m_map;
    bool m_has_materials = true;
    std::unique_ptr<MeshBuffers> m_buffers; // of a mesh
    std::unique_ptr<StrandBuffers> m_strands; // of strands
    MaterialTextures m_materials;
    ExactMesh m_exact;
    MapTextures m_map_textures;
    std::array<LitTexture, 2> m_lit;
    std::array<std::vector<float>, 2> m_added;
    std::array<Texture, 2> m_added_textures; // the same
};

} // namespace vmlight::view
