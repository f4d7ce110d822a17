// SPDX-License-Identifier: Apache-2.0
#include "display_pass.h"

#include "shader_text.h"

#include <vmlight/base/format.h>

namespace vmlight::view {

namespace OCIO = OCIO_NAMESPACE;

namespace {

GLint filter_of(OCIO::Interpolation interpolation)
{
    // Tetrahedral interpolation is in the shader, from texels.
    return interpolation == OCIO::INTERP_NEAREST || interpolation == OCIO::INTERP_TETRAHEDRAL ? GL_NEAREST : GL_LINEAR;
}

Texture load_cube(const OCIO::GpuShaderDesc& description, unsigned index, std::string& sampler)
{
    const char *name = nullptr, *sampler_name = nullptr;
    unsigned edge = 0;
    OCIO::Interpolation interpolation = OCIO::INTERP_LINEAR;
    description.get3DTexture(index, name, sampler_name, edge, interpolation);
    const float* values = nullptr;
    description.get3DTextureValues(index, values);
    Texture texture = Texture::of(GL_TEXTURE_3D);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGB32F, GLsizei(edge), GLsizei(edge), GLsizei(edge), 0, GL_RGB, GL_FLOAT, values);
    texture.filter(filter_of(interpolation), filter_of(interpolation));
    sampler = sampler_name;
    return texture;
}

// A curve: one row, or, where that would be too long, several.
Texture load_curve(const OCIO::GpuShaderDesc& description, unsigned index, std::string& sampler)
{
    const char *name = nullptr, *sampler_name = nullptr;
    unsigned width = 0, height = 0;
    auto channel = OCIO::GpuShaderDesc::TEXTURE_RGB_CHANNEL;
    OCIO::Interpolation interpolation = OCIO::INTERP_LINEAR;
#if OCIO_VERSION_HEX >= 0x02030000
    auto dimensions = OCIO::GpuShaderDesc::TEXTURE_1D;
    description.getTexture(index, name, sampler_name, width, height, channel, dimensions, interpolation);
    const bool has_rows = dimensions == OCIO::GpuShaderDesc::TEXTURE_2D;
#else
    description.getTexture(index, name, sampler_name, width, height, channel, interpolation);
    const bool has_rows = height > 1;
#endif
    const float* values = nullptr;
    description.getTextureValues(index, values);
    const bool is_red = channel == OCIO::GpuShaderDesc::TEXTURE_RED_CHANNEL;
    const GLint stored = is_red ? GL_R32F : GL_RGB32F;
    const GLenum given = is_red ? GL_RED : GL_RGB;
    Texture texture = Texture::of(has_rows ? GL_TEXTURE_2D : GL_TEXTURE_1D);
    if (has_rows)
        glTexImage2D(GL_TEXTURE_2D, 0, stored, GLsizei(width), GLsizei(height), 0, given, GL_FLOAT, values);
    else
        glTexImage1D(GL_TEXTURE_1D, 0, stored, GLsizei(width), 0, given, GL_FLOAT, values);
    texture.filter(filter_of(interpolation), filter_of(interpolation));
    sampler = sampler_name;
    return texture;
}

} // namespace

bool DisplayPass::build(const OCIO::ConstProcessorRcPtr& processor, std::string& error)
{
    DisplayPass made;
    try {
        OCIO::GpuShaderDescRcPtr description = OCIO::GpuShaderDesc::CreateShaderDesc();
        description->setLanguage(OCIO::GPU_LANGUAGE_GLSL_4_0);
        description->setFunctionName("to_display");
        description->setResourcePrefix("ocio_");
        processor->getOptimizedGPUProcessor(OCIO::OPTIMIZATION_DEFAULT)->extractGpuShaderInfo(description);
        made.m_description = description;
    } catch (const OCIO::Exception& exception) {
        error = format("OpenColorIO has no shader for this view: {}", exception.what());
        return false;
    }
    if (!made.load_tables(made.m_tables, error)
        || !made.m_program.build_whole({ made.m_description->getShaderText(), shader_text::display_frag }, error))
        return false;
    *this = std::move(made);
    return true;
}

bool DisplayPass::load_tables(std::vector<Table>& dst, std::string& error) const
{
    GLint units = 0;
    glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
    const unsigned cubes = m_description->getNum3DTextures(), curves = m_description->getNumTextures();
    if (int(cubes + curves) >= units) {
        error = format("this view needs {} lookup tables; the graphics driver has room for {}", cubes + curves,
                       units - 1);
        return false;
    }
    for (unsigned i = 0; i < cubes; ++i) {
        Table& table = dst.emplace_back();
        table.texture = load_cube(*m_description, i, table.sampler);
    }
    for (unsigned i = 0; i < curves; ++i) {
        Table& table = dst.emplace_back();
        table.texture = load_curve(*m_description, i, table.sampler);
    }
    return true;
}

// Those of transforms that may change while they are in use.
void DisplayPass::set_uniforms() const
{
    for (unsigned i = 0; i < m_description->getNumUniforms(); ++i) {
        OCIO::GpuShaderDesc::UniformData data;
        const char* name = m_description->getUniform(i, data);
        const GLint place = glGetUniformLocation(m_program.get(), name);
        if (data.m_getDouble)
            glUniform1f(place, float(data.m_getDouble()));
        else if (data.m_getBool)
            glUniform1f(place, data.m_getBool() ? 1.0f : 0.0f);
        else if (data.m_getFloat3)
            glUniform3fv(place, 1, data.m_getFloat3().data());
        else if (data.m_vectorFloat.m_getSize && data.m_vectorFloat.m_getVector)
            glUniform1fv(place, data.m_vectorFloat.m_getSize(), data.m_vectorFloat.m_getVector());
        else if (data.m_vectorInt.m_getSize && data.m_vectorInt.m_getVector)
            glUniform1iv(place, data.m_vectorInt.m_getSize(), data.m_vectorInt.m_getVector());
    }
}

void DisplayPass::run(const Texture& scene, float gain, int width, int height) const
{
    m_program.use();
    m_program.set("scene", 0, scene);
    m_program.set("exposure_gain", gain);
    m_program.set("scene_scale", 1.0f / float(width), 1.0f / float(height));
    for (size_t i = 0; i < m_tables.size(); ++i)
        m_program.set(m_tables[i].sampler.c_str(), int(i) + 1, m_tables[i].texture);
    set_uniforms();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    draw_whole_viewport();
}

} // namespace vmlight::view
