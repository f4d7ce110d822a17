// SPDX-License-Identifier: Apache-2.0
#include "headless.h"

#include "fault.h"

#include <vmlight/base/format.h>

#include <epoxy/egl.h>

#include <vector>

namespace vmlight::view {
namespace {

// Displays that need no server, the surest first: Mesa's without surfaces, then a graphics card's own.
std::vector<EGLDisplay> serverless_displays()
{
    std::vector<EGLDisplay> displays;
    const auto add = [&](EGLenum platform, void* native) {
        if (const EGLDisplay display = eglGetPlatformDisplayEXT(platform, native, nullptr))
            displays.push_back(display);
    };
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base"))
        return displays;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        add(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY);
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device")
        && epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
        EGLDeviceEXT devices[16];
        EGLint count = 0;
        if (eglQueryDevicesEXT(16, devices, &count))
            for (EGLint i = 0; i < count; ++i)
                add(EGL_PLATFORM_DEVICE_EXT, devices[i]);
    }
    return displays;
}

} // namespace

std::unique_ptr<HeadlessContext> HeadlessContext::open(std::string& error)
{
    error = "EGL has no display without a display server";
    std::unique_ptr<HeadlessContext> context(new HeadlessContext);
    for (EGLDisplay display : serverless_displays())
        if (context->start(display, error)) {
            error.clear();
            return context;
        }
    error = format("no OpenGL 4.1 without a window here ({}); install Mesa's EGL (libegl1, libgl1-mesa-dri)", error);
    return nullptr;
}

bool HeadlessContext::start(void* display, std::string& error)
{
    static const EGLint kConfig[] = { EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_NONE };
    static const EGLint kContext[] = { EGL_CONTEXT_MAJOR_VERSION,
                                       4,
                                       EGL_CONTEXT_MINOR_VERSION,
                                       1,
                                       EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                       EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                       EGL_CONTEXT_OPENGL_DEBUG,
                                       EGL_TRUE,
                                       EGL_NONE };
    if (!eglInitialize(display, nullptr, nullptr)) {
        error = format("eglInitialize gives {:#x}", eglGetError());
        return false;
    }
    EGLConfig config = nullptr;
    EGLint count = 0;
    EGLContext context = EGL_NO_CONTEXT;
    if (eglBindAPI(EGL_OPENGL_API) && eglChooseConfig(display, kConfig, &config, 1, &count) && count == 1)
        context = eglCreateContext(display, config, EGL_NO_CONTEXT, kContext);
    if (context && !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        eglDestroyContext(display, context);
        context = EGL_NO_CONTEXT;
    }
    if (!context) {
        error = format("EGL gives {:#x}", eglGetError());
        eglTerminate(display);
        return false;
    }
    m_display = display;
    m_context = context;
    watch_gl();
    return true;
}

HeadlessContext::~HeadlessContext()
{
    if (!m_context)
        return;
    eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(m_display, m_context);
    eglTerminate(m_display);
}

} // namespace vmlight::view
