// SPDX-License-Identifier: Apache-2.0
#include "window.h"

#include "fault.h"

#include <vmlight/base/format.h>

#include <epoxy/gl.h>
// After epoxy, which it would else replace.
#include <GLFW/glfw3.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>

namespace vmlight::view {
namespace {

std::string g_glfw_error;

void remember_error(int, const char* text)
{
    g_glfw_error = text;
}

Window& owner_of(GLFWwindow* window)
{
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

} // namespace

std::unique_ptr<Window> Window::open(int width, int height, const std::string& title, bool is_debug, std::string& error)
{
    glfwSetErrorCallback(remember_error);
    if (!glfwInit()) {
        error = format("no window can be opened here ({}); -o PICTURE renders without one", g_glfw_error);
        return nullptr;
    }
    std::unique_ptr<Window> window(new Window);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 1);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, is_debug ? GLFW_TRUE : GLFW_FALSE);
    window->m_window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!window->m_window) {
        error = format("no window with OpenGL 4.1 can be opened here ({})", g_glfw_error);
        return nullptr;
    }
    glfwMakeContextCurrent(window->m_window);
    glfwSwapInterval(1);
    watch_gl();
    glfwSetWindowUserPointer(window->m_window, window.get());
    glfwSetDropCallback(window->m_window, [](GLFWwindow* handle, int count, const char** paths) {
        Window& owner = owner_of(handle);
        owner.m_dropped.insert(owner.m_dropped.end(), paths, paths + count);
    });
    // ImGui calls the callbacks that were there before its own.
    glfwSetKeyCallback(window->m_window, [](GLFWwindow* handle, int key, int, int action, int modifiers) {
        if (action == GLFW_PRESS)
            owner_of(handle).m_keys.push_back({ key, modifiers });
    });

    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // settings.h stores the settings
    ImGui::StyleColorsDark();
    ImGui_ImplGlfw_InitForOpenGL(window->m_window, true);
    ImGui_ImplOpenGL3_Init("#version 410 core");
    window->m_has_imgui = true;
    return window;
}

Window::~Window()
{
    if (m_has_imgui) {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    if (m_window)
        glfwDestroyWindow(m_window);
    glfwTerminate();
}

bool Window::should_close() const
{
    return glfwWindowShouldClose(m_window) != 0;
}

void Window::close()
{
    glfwSetWindowShouldClose(m_window, GLFW_TRUE);
}

void Window::wait_for_events(double seconds)
{
    if (seconds > 0)
        glfwWaitEventsTimeout(seconds);
    else
        glfwPollEvents();
}

void Window::wake()
{
    glfwPostEmptyEvent();
}

std::vector<PressedKey> Window::take_keys()
{
    std::vector<PressedKey> keys;
    keys.swap(m_keys);
    return keys;
}

std::vector<std::string> Window::take_dropped()
{
    std::vector<std::string> dropped;
    dropped.swap(m_dropped);
    return dropped;
}

void Window::begin_frame()
{
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Window::end_frame()
{
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glfwSwapBuffers(m_window);
}

int Window::width() const
{
    int width = 0, height = 0;
    glfwGetFramebufferSize(m_window, &width, &height);
    return std::max(1, width);
}

int Window::height() const
{
    int width = 0, height = 0;
    glfwGetFramebufferSize(m_window, &width, &height);
    return std::max(1, height);
}

double Window::scale() const
{
    int across = 0, down = 0;
    get_size(across, down);
    return double(width()) / std::max(1, across);
}

void Window::get_size(int& width, int& height) const
{
    glfwGetWindowSize(m_window, &width, &height);
}

void Window::set_title(const std::string& title)
{
    glfwSetWindowTitle(m_window, title.c_str());
}

} // namespace vmlight::view
