// SPDX-License-Identifier: Apache-2.0
/// Shaders, compiled and linked, and their uniforms by name.
#pragma once

#include "objects.h"

#include <string>
#include <vector>

namespace vmlight::view {

void free_program(GLuint name);

class Program
{
public:
    /// Compile and link. Each shader is its pieces one after the other, below a line that asks for GLSL 4.10.
    /// Attributes get the places 0, 1, ... in the order of `attributes`.
    ///
    /// @returns false, with the compiler's words in `error`.
    bool build(const std::vector<std::string>& vertex, const std::vector<std::string>& fragment, std::string& error,
               const std::vector<const char*>& attributes = {});
    /// One whose vertices cover the viewport: draw_whole_viewport().
    bool build_whole(const std::vector<std::string>& fragment, std::string& error);

    /// Make it current, for set() and for drawing.
    void use() const;
    GLuint get() const { return m_name.get(); }
    explicit operator bool() const { return bool(m_name); }

    // Of the current program. A uniform that the compiler found unused is left alone.
    void set(const char* name, int value) const;
    void set(const char* name, float value) const;
    void set(const char* name, float x, float y) const;
    void set(const char* name, float x, float y, float z) const;
    /// `count` numbers, or vectors of four.
    void set_floats(const char* name, const float* values, int count) const;
    void set_vectors(const char* name, const float* xyzw, int count) const;
    /// Bind `texture` to `unit`, and the sampler `name` to that.
    void set(const char* name, int unit, const Texture& texture) const;

private:
    GlName<free_program> m_name;
};

} // namespace vmlight::view
