// SPDX-License-Identifier: Apache-2.0
#include "relight_pass.h"

#include "shader_text.h"

#include <vmlight/lightmap/model_sh.h>
#include <vmlight/lightmap/model_shader.h>

#include <cmath>

namespace vmlight::view {

bool has_relight_shader(const std::string& model)
{
    return model == "ao" || model == "paper" || model == "lobe" || model == "sh";
}

bool RelightPass::build(std::string& error)
{
    m_none = Texture::image(1, 1, GL_RGBA32F);
    return m_cfem.build_whole({ shader_text::lookup_glsl, shader_text::relight_cfem_frag }, error)
        && m_lobe.build_whole({ shader_text::lookup_glsl, shader_text::relight_lobe_frag }, error)
        && m_sh.build_whole({ shader_text::lookup_glsl, shader_text::relight_sh_frag }, error)
        && m_pyramid.build(error);
}

bool RelightPass::set_harmonics(const MapTextures& map, const OIIO::ImageBuf& radiance, const Rotation& rotation,
                                float gain, std::string& error) const
{
    HarmonicLight harmonics;
    const int bands = int(std::lround(std::sqrt(map.harmonics)));
    if (!build_harmonic_light(harmonics, radiance, bands, rotation, error))
        return false;
    m_sh.set_vectors("harmonics", harmonics.coefficients.data(), harmonics.count);
    m_sh.set("count", harmonics.count);
    float most[3];
    for (int c = 0; c < 3; ++c)
        most[c] = harmonics.brightest[c] * gain * kAboveRounding;
    m_sh.set("brightest", most[0], most[1], most[2]);
    return true;
}

bool RelightPass::run(LitTexture& dst, const MapTextures& map, const LightTextures& light,
                      const OIIO::ImageBuf* radiance, const Texture* added, const LightmapParams& params,
                      std::string& error) const
{
    Rotation rotation;
    if (!lightmap_rotation(rotation, params, error))
        return false;
    if (!dst.fits(map.width, map.height))
        dst = LitTexture(map.width, map.height);
    const float gain = float(std::exp2(params.exposure));
    const Program& program = params.model == "lobe" ? m_lobe : params.model == "sh" ? m_sh : m_cfem;
    program.use();
    program.set("map", 0, map.layers);
    program.set("gain", gain);
    program.set("has_added", int(added != nullptr));
    program.set("added", 2, added ? *added : m_none);
    if (params.model == "sh") {
        if (!set_harmonics(map, *radiance, rotation, gain, error))
            return false;
    } else {
        float numbers[9];
        for (int i = 0; i < 9; ++i)
            numbers[i] = float(rotation[i / 3][i % 3]);
        program.set_floats("rotation", numbers, 9);
        glUniform2i(glGetUniformLocation(program.get(), "light_size"), light.width, light.height);
    }
    if (params.model == "lobe") {
        program.set("lobes", 1, light.lobes);
        float brightest[3];
        for (int c = 0; c < 3; ++c)
            brightest[c] = light.brightest[c] * gain * kAboveRounding;
        program.set("brightest", brightest[0], brightest[1], brightest[2]);
        program.set("is_of_strands", int(map.is_of_strands));
        program.set("around", 3, map.is_of_strands ? light.cfem : m_none);
    } else if (params.model != "sh") {
        program.set("cfem", 1, light.cfem);
        program.set("uses_normal", int(params.model == "ao"));
    }
    dst.level(0).bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    draw_whole_viewport();
    m_pyramid.run(dst);
    return true;
}

} // namespace vmlight::view
