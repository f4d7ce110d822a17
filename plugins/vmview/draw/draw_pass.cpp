// SPDX-License-Identifier: Apache-2.0
#include "draw_pass.h"

#include "shader_text.h"

#include <vmlight/base/format.h>

#include <algorithm>
#include <cmath>

namespace vmlight::view {
namespace {

void set_texture(const Program& program, const char* name, const LitTexture& texture)
{
    program.set(name, 0, texture.texture());
    program.set("texels", float(texture.texture().width()), float(texture.texture().height()));
    program.set("last_level", texture.levels() - 1);
}

bool build_mesh(Program& program, bool is_exact, int show, int material, std::string& error)
{
    const std::string camera = shader_text::camera_glsl, point = shader_text::point_glsl;
    const std::string ways = format("#define SHOW {}\n#define MATERIAL {}\n", show, material);
    if (is_exact)
        return program.build({ camera, shader_text::exact_vert },
                             { camera, point, shader_text::exact_point_glsl, ways, shader_text::mesh_frag }, error);
    return program.build({ camera, shader_text::mesh_vert },
                         { camera, point, shader_text::drawn_point_glsl, ways, shader_text::mesh_frag }, error,
                         { std::begin(kMeshAttributes), std::end(kMeshAttributes) });
}

} // namespace

bool DrawPass::build(std::string& error)
{
    const std::string camera = shader_text::camera_glsl;
    // The usual one now, so that a driver that cannot compile it is found out.
    return build_mesh(m_mesh[{ 0, 0, 0 }], 0, 0, 0, error)
        && m_backdrop.build_whole({ "#define EXACT 0\n", camera, shader_text::backdrop_frag }, error)
        && m_exact_backdrop.build_whole({ "#define EXACT 1\n", camera, shader_text::backdrop_frag }, error)
        && m_accumulate.build_whole({ shader_text::accumulate_frag }, error);
}

const Program& DrawPass::mesh_program(bool is_exact, Show show, int material) const
{
    Program& program = m_mesh[{ int(is_exact), int(show), material }];
    std::string ignored; // one of them has been compiled; the rest are its words in another order
    if (!program)
        build_mesh(program, is_exact, int(show), material, ignored);
    return program;
}

void DrawPass::begin(const Backdrop& backdrop, const View& view, bool is_exact) const
{
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glDepthMask(GL_TRUE);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    if (!backdrop.environment)
        return;
    glDisable(GL_DEPTH_TEST);
    const Program& program = is_exact ? m_exact_backdrop : m_backdrop;
    program.use();
    set_view(program, view, view.camera.position);
    float numbers[9];
    for (int i = 0; i < 9; ++i)
        numbers[i] = float(backdrop.to_environment[i / 3][i % 3]);
    program.set_floats("rotation", numbers, 9);
    set_texture(program, "environment", *backdrop.environment);
    draw_whole_viewport();
}

void DrawPass::draw(const MeshBuffers& mesh, const ExactMesh* exact, const MaterialTextures& materials,
                    const Subject& subject, const LitTexture& lit, Show show, const View& view, int first,
                    int end) const
{
    const bool is_exact = exact && !exact->is_empty();
    const Imath::V2d range = depth_range_of(view.camera, subject);
    const double texels = std::sqrt(double(lit.texture().width()) * lit.texture().height());
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glEnable(GL_SCISSOR_TEST);
    glScissor(first, 0, std::max(0, end - first), view.height);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    for (const MeshPart& part : is_exact ? exact->parts() : mesh.parts()) {
        const Program& program = mesh_program(is_exact, show, materials.kind(part.material));
        program.use();
        set_view(program, view, mesh.centre());
        program.set("depth_range", float(range.x), float(range.y));
        set_texture(program, "lit", lit);
        program.set("density_scale", float(std::max(mesh.texture_share() * texels, 1e-30)));
        if (is_exact)
            program.set("corners", 1, exact->corners());
        materials.set(program, part.material);
        (materials.is_blended(part.material) ? glEnable : glDisable)(GL_BLEND);
        if (is_exact)
            glDrawArrays(GL_TRIANGLES, part.first, part.count);
        else
            mesh.draw(part);
    }
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
}

void DrawPass::accumulate(const Texture& picture, double share) const
{
    m_accumulate.use();
    m_accumulate.set("picture", 0, picture);
    m_accumulate.set("share", float(share));
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    draw_whole_viewport();
    glDisable(GL_BLEND);
}

} // namespace vmlight::view
