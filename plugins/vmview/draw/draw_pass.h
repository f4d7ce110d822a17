// SPDX-License-Identifier: Apache-2.0
/// The picture in scene-linear light: the mesh with its lit texture, before the environment or nothing.
#pragma once

#include "../gl/program.h"
#include "../relight/lit_texture.h"
#include "exact_mesh.h"
#include "material_textures.h"
#include "mesh_buffers.h"
#include "view.h"

#include <vmlight/frame/camera.h>
#include <vmlight/math/rotation.h>

#include <array>
#include <map>
#include <string>

namespace vmlight::view {

/// An environment to be seen: a lat-long map with its mip levels, and how it is turned.
struct Backdrop
{
    const LitTexture* environment = nullptr; ///< nullptr: nothing, alpha 0
    Rotation to_environment;
};

class DrawPass
{
public:
    bool build(std::string& error);

    /// Start a picture in the bound framebuffer, which has a depth buffer.
    void begin(const Backdrop& backdrop, const View& view, bool is_exact) const;
    /// Draw the mesh into it, in columns [`first`, `end`) only; `exact`, unless it is nullptr or empty, in its place.
    void draw(const MeshBuffers& mesh, const ExactMesh* exact, const MaterialTextures& materials,
              const Subject& subject, const LitTexture& lit, Show show, const View& view, int first, int end) const;
    /// Add `share` of `picture` to the bound framebuffer.
    void accumulate(const Texture& picture, double share) const;

private:
    // A program for each way to draw, made when it is first needed.
    const Program& mesh_program(bool is_exact, Show show, int material) const;

    Program m_backdrop, m_exact_backdrop, m_accumulate;
    mutable std::map<std::array<int, 3>, Program> m_mesh;
};

} // namespace vmlight::view
