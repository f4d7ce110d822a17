// SPDX-License-Identifier: Apache-2.0
#include "strand_pass.h"

#include "shader_text.h"

#include <vmlight/base/format.h>

#include <algorithm>
#include <cmath>

namespace vmlight::view {
namespace {

// As many as Embree draws a span of a flat curve with.
constexpr int kPieces = 4;
constexpr double kPieceLength = 8; // of quick ones, in footprints of a texture lookup: pixels, if there is one sample

bool build_ribbons(Program& program, Show show, RibbonMode mode, bool has_highlights, std::string& error)
{
    const std::string ways = format("#define SHOW {}\n#define MODE {}\n#define HIGHLIGHTS {}\n", int(show), int(mode),
                                    int(has_highlights));
    const std::string camera = shader_text::camera_glsl;
    return program.build({ ways, camera, shader_text::strand_vert }, { ways, camera, shader_text::strand_frag }, error);
}

} // namespace

bool StrandPass::build(std::string& error)
{
    return build_ribbons(m_programs[{ int(Show::lit), int(RibbonMode::quick), 0 }], Show::lit, RibbonMode::quick, false,
                         error);
}

const Program& StrandPass::program(Show show, RibbonMode mode, bool has_highlights) const
{
    Program& program = m_programs[{ int(show), int(mode), int(has_highlights) }];
    std::string ignored; // one of them has been compiled; the rest are its words in another order
    if (!program)
        build_ribbons(program, show, mode, has_highlights, ignored);
    return program;
}

int quick_pieces(const StrandBuffers& strands, const View& view)
{
    const Camera& camera = view.camera;
    const double depth
        = camera.is_orthographic ? 1 : std::max((strands.centre() - camera.position).dot(camera.forward), 1e-30);
    const double pixels = strands.span_length() / (2 * depth * camera.half_height) * view.height;
    return int(std::clamp(std::ceil(pixels / (kPieceLength * view.footprint)), 1.0, double(kPieces)));
}

void StrandPass::draw(const StrandBuffers& strands, const LitTexture& lit, const Imath::C3f& color,
                      const Highlights& highlights, const Subject& subject, Show show, RibbonMode mode,
                      const View& view, int first, int end) const
{
    const bool has_highlights = show == Show::lit && highlights.cones && *highlights.cones;
    const Program& program = this->program(show, mode, has_highlights);
    const Imath::V2d range = depth_range_of(view.camera, subject);
    const int pieces = mode == RibbonMode::quick ? quick_pieces(strands, view) : kPieces;
    program.use();
    set_view(program, view, strands.centre());
    program.set("depth_range", float(range.x), float(range.y));
    program.set("lit", 0, lit.texture());
    program.set("controls", 1, strands.controls());
    program.set("spans", 2, strands.span_table());
    program.set("sample_number", view.sample);
    program.set("pieces", pieces);
    program.set("texels", strands.layout().texels);
    program.set("rows", strands.layout().rows);
    program.set("strand_color", color.x, color.y, color.z);
    if (has_highlights) {
        float numbers[9];
        for (int i = 0; i < 9; ++i)
            numbers[i] = float(highlights.to_environment[i / 3][i % 3]);
        program.set_floats("rotation", numbers, 9);
        program.set("cones", 3, *highlights.cones);
        program.set("map", 4, *highlights.map);
        program.set("strength", float(highlights.strength));
    }
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDisable(GL_BLEND);
    glEnable(GL_SCISSOR_TEST);
    glScissor(first, 0, std::max(0, end - first), view.height);
    glDrawArrays(GL_TRIANGLES, 0, 6 * pieces * strands.spans());
    glDisable(GL_SCISSOR_TEST);
}

} // namespace vmlight::view
