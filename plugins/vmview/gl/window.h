// SPDX-License-Identifier: Apache-2.0
/// A window with an OpenGL context and Dear ImGui, through GLFW.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;

namespace vmlight::view {

/// GLFW's numbers.
struct PressedKey
{
    int key = 0, modifiers = 0;
};

class Window
{
public:
    /// Open a window whose OpenGL 4.1 core context is current on this thread; a debug context if asked for. nullptr,
    /// with the reason in `error`, where there is no display or no such OpenGL.
    static std::unique_ptr<Window> open(int width, int height, const std::string& title, bool is_debug,
                                        std::string& error);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    bool should_close() const;
    void close();
    /// Wait until something happens, `seconds` at most; 0: only look.
    void wait_for_events(double seconds);
    /// Wake wait_for_events(), from any thread.
    static void wake();
    /// Keys that were pressed since the last call, however briefly; ImGui knows only what is down when it looks.
    std::vector<PressedKey> take_keys();
    /// Files that were dropped on the window since the last call.
    std::vector<std::string> take_dropped();

    /// Between them ImGui is called.
    void begin_frame();
    /// Draw what ImGui has over what is in the window, and show it.
    void end_frame();

    // In pixels of the framebuffer; the window's own units may be larger.
    int width() const;
    int height() const;
    /// Pixels to a unit of the window, in which ImGui and the mouse count.
    double scale() const;
    /// Size in units of the window.
    void get_size(int& width, int& height) const;
    void set_title(const std::string& title);

private:
    Window() = default;

    GLFWwindow* m_window = nullptr;
    bool m_has_imgui = false;
    std::vector<std::string> m_dropped;
    std::vector<PressedKey> m_keys;
};

} // namespace vmlight::view
