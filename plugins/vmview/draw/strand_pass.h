// SPDX-License-Identifier: Apache-2.0
/// Strands in a picture: ribbons that face the eye, as wide as the strand, as rays from a camera meet them in frames.
#pragma once

#include "../gl/program.h"
#include "../relight/lit_texture.h"
#include "strand_buffers.h"
#include "view.h"

#include <vmlight/math/rotation.h>

#include <Imath/ImathColor.h>

#include <array>
#include <map>
#include <string>

namespace vmlight::view {

/// How ribbons are drawn.
enum class RibbonMode
{
    /// At least a pixel wide, with as many of their pixels as they cover: nothing that is thin is lost in one sample.
    quick,
    /// Each sample decided to float's precision, at the ribbon's own width; depth as mesh.vert has it.
    exact,
    /// The same; depth as exact_point.glsl has it.
    exact_beside_exact_mesh
};

/// The highlights of strands at one rotation: frame/strand_specular.h.
struct Highlights
{
    const Texture* cones = nullptr; ///< ConeLevels, a layer each; nullptr: none
    const Texture* map = nullptr; ///< MapTextures::layers
    double strength = 0;
    Rotation to_environment;
};

class StrandPass
{
public:
    /// Compile what a window needs. False, with the reason in `error`, if the driver refuses it.
    bool build(std::string& error);

    /// Draw strands into the bound framebuffer, which has a depth buffer, in columns [`first`, `end`) only.
    ///
    /// @param subject  all that is drawn: its depths are those of the depth buffer
    void draw(const StrandBuffers& strands, const LitTexture& lit, const Imath::C3f& color,
              const Highlights& highlights, const Subject& subject, Show show, RibbonMode mode, const View& view,
              int first, int end) const;

private:
    const Program& program(Show show, RibbonMode mode, bool has_highlights) const;
    mutable std::map<std::array<int, 3>, Program> m_programs; // made when they are first needed
};

/// How many straight pieces quick draws each span with, from one knot of a curve to the next: the more, the more pixels
/// and samples there are.
int quick_pieces(const StrandBuffers& strands, const View& view);

} // namespace vmlight::view
