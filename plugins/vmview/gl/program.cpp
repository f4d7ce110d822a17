// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include "shader_text.h"

#include <vmlight/base/format.h>

#include <algorithm>

namespace vmlight::view {
namespace {

void free_shader(GLuint name)
{
    glDeleteShader(name);
}
using Shader = GlName<free_shader>;

Shader compile(GLenum kind, const std::vector<std::string>& pieces, std::string& error)
{
    std::vector<const char*> texts { "#version 410 core\n" };
    for (const std::string& piece : pieces)
        texts.push_back(piece.c_str());
    Shader shader(glCreateShader(kind));
    glShaderSource(shader.get(), GLsizei(texts.size()), texts.data(), nullptr);
    glCompileShader(shader.get());
    GLint good = 0;
    glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &good);
    if (good)
        return shader;
    char log[2048] = "";
    glGetShaderInfoLog(shader.get(), sizeof(log), nullptr, log);
    error = format("a shader does not compile: {}", log);
    return {};
}

} // namespace

void free_program(GLuint name)
{
    glDeleteProgram(name);
}

bool Program::build(const std::vector<std::string>& vertex, const std::vector<std::string>& fragment,
                    std::string& error, const std::vector<const char*>& attributes)
{
    const Shader first = compile(GL_VERTEX_SHADER, vertex, error);
    const Shader second = first ? compile(GL_FRAGMENT_SHADER, fragment, error) : Shader();
    if (!second)
        return false;
    GlName<free_program> name(glCreateProgram());
    glAttachShader(name.get(), first.get());
    glAttachShader(name.get(), second.get());
    for (size_t i = 0; i < attributes.size(); ++i)
        glBindAttribLocation(name.get(), GLuint(i), attributes[i]);
    glLinkProgram(name.get());
    GLint good = 0;
    glGetProgramiv(name.get(), GL_LINK_STATUS, &good);
    if (!good) {
        char log[2048] = "";
        glGetProgramInfoLog(name.get(), sizeof(log), nullptr, log);
        error = format("shaders do not link: {}", log);
        return false;
    }
    m_name = std::move(name);
    return true;
}

bool Program::build_whole(const std::vector<std::string>& fragment, std::string& error)
{
    return build({ shader_text::whole_vert }, fragment, error);
}

void Program::use() const
{
    glUseProgram(m_name.get());
}

void Program::set(const char* name, int value) const
{
    glUniform1i(glGetUniformLocation(get(), name), value);
}

void Program::set(const char* name, float value) const
{
    glUniform1f(glGetUniformLocation(get(), name), value);
}

void Program::set(const char* name, float x, float y) const
{
    glUniform2f(glGetUniformLocation(get(), name), x, y);
}

void Program::set(const char* name, float x, float y, float z) const
{
    glUniform3f(glGetUniformLocation(get(), name), x, y, z);
}

void Program::set_floats(const char* name, const float* values, int count) const
{
    glUniform1fv(glGetUniformLocation(get(), name), count, values);
}

void Program::set_vectors(const char* name, const float* xyzw, int count) const
{
    glUniform4fv(glGetUniformLocation(get(), name), count, xyzw);
}

void Program::set(const char* name, int unit, const Texture& texture) const
{
    texture.bind(unit);
    set(name, unit);
}

} // namespace vmlight::view
