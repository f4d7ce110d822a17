// SPDX-License-Identifier: Apache-2.0
/// OpenGL's objects, each owned by one C++ object. All need the context current in which they were made.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <utility>

namespace vmlight::view {

/// Moves and destroys one name that OpenGL gave. `Free` deletes it.
template <void (*Free)(GLuint)> class GlName
{
public:
    GlName() = default;
    explicit GlName(GLuint name)
        : m_name(name)
    {
    }
    GlName(GlName&& other) noexcept
        : m_name(std::exchange(other.m_name, 0))
    {
    }
    GlName& operator=(GlName&& other) noexcept
    {
        std::swap(m_name, other.m_name);
        return *this;
    }
    ~GlName()
    {
        if (m_name)
            Free(m_name);
    }
    GLuint get() const { return m_name; }
    explicit operator bool() const { return m_name != 0; }

private:
    GLuint m_name = 0;
};

void free_texture(GLuint name);
void free_framebuffer(GLuint name);
void free_buffer(GLuint name);
void free_vertex_array(GLuint name);

using VertexArray = GlName<free_vertex_array>;
using Buffer = GlName<free_buffer>;
using FramebufferName = GlName<free_framebuffer>;

VertexArray make_vertex_array();
/// A buffer of `bytes` bytes of `data`, bound to `target`.
Buffer make_buffer(GLenum target, const void* data, size_t bytes);

/// A texture of any kind, with nearest filtering and clamped edges by default.
class Texture
{
public:
    Texture() = default;
    /// Two-dimensional, `levels` mip levels, each half the one before (rounded down, at least 1), without pixels;
    /// several levels are filtered.
    static Texture image(int width, int height, GLenum format, int levels = 1);
    /// The same with pixels: rows from the top of the image, which are rows from t = 0 up for OpenGL.
    static Texture image(int width, int height, GLenum format, GLenum pixels, const float* data);
    /// Layers of one size, without pixels.
    static Texture layers(int width, int height, int count, GLenum format);
    /// The texels of a buffer, which must outlive it.
    static Texture of_buffer(const Buffer& buffer, GLenum format);
    /// Any other kind, to be filled by the caller.
    static Texture of(GLenum target);

    GLuint get() const { return m_name.get(); }
    GLenum target() const { return m_target; }
    int width() const { return m_width; }
    int height() const { return m_height; }
    int levels() const { return m_levels; }
    explicit operator bool() const { return bool(m_name); }

    void bind(int unit) const;
    void filter(GLint minify, GLint magnify);
    /// Fill one layer, or level 0, with floats.
    void fill_layer(int layer, GLenum pixels, const float* data);
    void fill(GLenum pixels, const float* data);

private:
    GlName<free_texture> m_name;
    GLenum m_target = GL_TEXTURE_2D;
    int m_width = 0, m_height = 0, m_levels = 1;
};

/// A framebuffer that draws into one level of a texture, with a depth buffer of floats if asked for.
class Framebuffer
{
public:
    Framebuffer() = default;
    Framebuffer(int width, int height, GLenum format, bool has_depth);
    /// Draw into `level` of `texture`, which must outlive it.
    explicit Framebuffer(const Texture& texture, int level = 0);

    /// Bind it for drawing, with the viewport over all of it.
    void bind() const;
    /// Floats of R, G, B, A, rows as OpenGL keeps them: the first is the bottom.
    void read(float* rgba) const;
    void read_rect(int x, int y, int width, int height, float* rgba) const;
    const Texture& color() const { return m_color; }
    int width() const { return m_width; }
    int height() const { return m_height; }
    GLuint get() const { return m_name.get(); }
    explicit operator bool() const { return bool(m_name); }

private:
    void attach(GLuint texture, int level);

    FramebufferName m_name;
    Texture m_color, m_depth;
    int m_width = 0, m_height = 0;
};

/// Draw a triangle that covers the viewport; needs a vertex array bound, which may be empty.
void draw_whole_viewport();

} // namespace vmlight::view
