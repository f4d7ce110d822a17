// SPDX-License-Identifier: Apache-2.0
#include "fault.h"

#include <vmlight/base/format.h>

#include <epoxy/gl.h>

namespace vmlight::view {
namespace {

// Of the one thread that draws.
std::string g_first_fault;

void APIENTRY report_message(GLenum, GLenum type, GLuint, GLenum, GLsizei length, const GLchar* text, const void*)
{
    const bool is_wrong = type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR;
    if (is_wrong && g_first_fault.empty())
        g_first_fault.assign(text, length < 0 ? std::char_traits<char>::length(text) : size_t(length));
}

} // namespace

void watch_gl()
{
    g_first_fault.clear();
    if (!epoxy_has_gl_extension("GL_KHR_debug"))
        return;
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS); // so that a debugger stops at the call
    glDebugMessageCallback(report_message, nullptr);
}

std::string gl_fault()
{
    for (GLenum code = glGetError(); code != GL_NO_ERROR; code = glGetError())
        if (g_first_fault.empty())
            g_first_fault = format("OpenGL error {:#x}", code);
    std::string fault;
    fault.swap(g_first_fault);
    return fault;
}

} // namespace vmlight::view
