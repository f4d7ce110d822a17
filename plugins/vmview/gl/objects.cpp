// SPDX-License-Identifier: Apache-2.0
#include "objects.h"

#include <algorithm>

namespace vmlight::view {
namespace {

GLuint new_texture()
{
    GLuint name = 0;
    glGenTextures(1, &name);
    return name;
}

} // namespace

void free_texture(GLuint name)
{
    glDeleteTextures(1, &name);
}

void free_framebuffer(GLuint name)
{
    glDeleteFramebuffers(1, &name);
}

void free_buffer(GLuint name)
{
    glDeleteBuffers(1, &name);
}

void free_vertex_array(GLuint name)
{
    glDeleteVertexArrays(1, &name);
}

VertexArray make_vertex_array()
{
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    return VertexArray(name);
}

Buffer make_buffer(GLenum target, const void* data, size_t bytes)
{
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(target, name);
    glBufferData(target, GLsizeiptr(bytes), data, GL_STATIC_DRAW);
    return Buffer(name);
}

Texture Texture::of(GLenum target)
{
    Texture texture;
    texture.m_name = GlName<free_texture>(new_texture());
    texture.m_target = target;
    texture.bind(0);
    texture.filter(GL_NEAREST, GL_NEAREST);
    for (GLenum axis : { GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R })
        glTexParameteri(target, axis, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
    // Rows of one or three floats are not multiples of eight bytes.
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    return texture;
}

Texture Texture::of_buffer(const Buffer& buffer, GLenum format)
{
    Texture texture;
    texture.m_name = GlName<free_texture>(new_texture());
    texture.m_target = GL_TEXTURE_BUFFER;
    texture.bind(0);
    glTexBuffer(GL_TEXTURE_BUFFER, format, buffer.get());
    return texture;
}

Texture Texture::image(int width, int height, GLenum format, int levels)
{
    Texture texture = of(GL_TEXTURE_2D);
    texture.m_width = width;
    texture.m_height = height;
    texture.m_levels = levels;
    const bool is_depth = format == GL_DEPTH_COMPONENT32F;
    // First, with a filter that needs them all: drivers that make room for one level alone move the texture once the
    // others are used, and framebuffers go on reading the old one (seen with Mesa 22.3).
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, levels - 1);
    if (levels > 1)
        texture.filter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
    for (int level = 0; level < levels; ++level)
        glTexImage2D(GL_TEXTURE_2D, level, GLint(format), std::max(1, width >> level), std::max(1, height >> level), 0,
                     is_depth ? GL_DEPTH_COMPONENT : GL_RGBA, GL_FLOAT, nullptr);
    return texture;
}

Texture Texture::image(int width, int height, GLenum format, GLenum pixels, const float* data)
{
    Texture texture = image(width, height, format);
    texture.fill(pixels, data);
    return texture;
}

Texture Texture::layers(int width, int height, int count, GLenum format)
{
    Texture texture = of(GL_TEXTURE_2D_ARRAY);
    texture.m_width = width;
    texture.m_height = height;
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GLint(format), width, height, count, 0, GL_RGBA, GL_FLOAT, nullptr);
    return texture;
}

void Texture::bind(int unit) const
{
    glActiveTexture(GLenum(GL_TEXTURE0 + unit));
    glBindTexture(m_target, m_name.get());
}

void Texture::filter(GLint minify, GLint magnify)
{
    bind(0);
    glTexParameteri(m_target, GL_TEXTURE_MIN_FILTER, minify);
    glTexParameteri(m_target, GL_TEXTURE_MAG_FILTER, magnify);
}

void Texture::fill_layer(int layer, GLenum pixels, const float* data)
{
    bind(0);
    glTexSubImage3D(m_target, 0, 0, 0, layer, m_width, m_height, 1, pixels, GL_FLOAT, data);
}

void Texture::fill(GLenum pixels, const float* data)
{
    bind(0);
    glTexSubImage2D(m_target, 0, 0, 0, m_width, m_height, pixels, GL_FLOAT, data);
}

Framebuffer::Framebuffer(int width, int height, GLenum format, bool has_depth)
    : m_color(Texture::image(width, height, format))
    , m_width(width)
    , m_height(height)
{
    attach(m_color.get(), 0);
    if (has_depth) {
        m_depth = Texture::image(width, height, GL_DEPTH_COMPONENT32F);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, m_depth.get(), 0);
    }
}

Framebuffer::Framebuffer(const Texture& texture, int level)
    : m_width(std::max(1, texture.width() >> level))
    , m_height(std::max(1, texture.height() >> level))
{
    attach(texture.get(), level);
}

void Framebuffer::attach(GLuint texture, int level)
{
    GLuint name = 0;
    glGenFramebuffers(1, &name);
    m_name = FramebufferName(name);
    glBindFramebuffer(GL_FRAMEBUFFER, name);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, level);
}

void Framebuffer::bind() const
{
    glBindFramebuffer(GL_FRAMEBUFFER, m_name.get());
    glViewport(0, 0, m_width, m_height);
}

void Framebuffer::read(float* rgba) const
{
    read_rect(0, 0, m_width, m_height, rgba);
}

void Framebuffer::read_rect(int x, int y, int width, int height, float* rgba) const
{
    glBindFramebuffer(GL_READ_FRAMEBUFFER, m_name.get());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(x, y, width, height, GL_RGBA, GL_FLOAT, rgba);
}

void draw_whole_viewport()
{
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

} // namespace vmlight::view
