// SPDX-License-Identifier: Apache-2.0
/// An OpenGL context without a window or a display server, through EGL.
#pragma once

#include <memory>
#include <string>

namespace vmlight::view {

class HeadlessContext
{
public:
    /// A debug context of OpenGL 4.1 core, current on this thread. nullptr, with the reason in `error`, if EGL has
    /// none.
    static std::unique_ptr<HeadlessContext> open(std::string& error);
    ~HeadlessContext();
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;

private:
    HeadlessContext() = default;
    bool start(void* display, std::string& error);

    void* m_display = nullptr; // EGLDisplay and EGLContext, without their header, which drags in that of X11
    void* m_context = nullptr;
};

} // namespace vmlight::view
