// SPDX-License-Identifier: Apache-2.0
/// The materials of a mesh on the graphics card.
#pragma once

#include "../gl/program.h"

#include <vmlight/frame/frame_scene.h>

#include <map>
#include <string>
#include <vector>

namespace vmlight::view {

class MaterialTextures
{
public:
    /// Load `materials`. False, with the reason in `error`, if a texture is larger than the driver allows.
    bool load(const std::vector<SurfaceMaterial>& materials, std::string& error);
    /// Set the uniforms of mesh.frag for one of them, or, for -1, for a white surface.
    void set(const Program& program, int material) const;
    bool is_blended(int material) const;
    /// What mesh.frag calls MATERIAL.
    int kind(int material) const;

private:
    std::vector<SurfaceMaterial> m_materials;
    std::map<const TexturePyramid*, Texture> m_textures;
};

} // namespace vmlight::view
