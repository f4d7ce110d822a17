// SPDX-License-Identifier: Apache-2.0
#include "app.h"

#include "../gl/fault.h"
#include "menus.h"
#include "panels.h"

#include <vmlight/base/format.h>
#include <vmlight/base/interrupt.h>
#include <vmlight/image/color.h>
#include <vmlight/image/picture_file.h>
#include <vmlight/lightmap/light_level.h>

#include <OpenImageIO/filesystem.h>

#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace vmlight::view {
namespace {

constexpr float kNearLine = 6; // within which the mouse takes hold of it

Request with_settings(Request request, const Settings& settings)
{
    if (!request.model_given)
        request.light.model = settings.model;
    if (!request.display_given)
        request.display = { settings.display, settings.view, settings.look };
    return request;
}

} // namespace

App::App(const Request& request, Window& window, int threads)
    : m_window(window)
    , m_settings_path(settings_path())
    , m_settings(read_settings(m_settings_path))
    , m_state(state_of(with_settings(request, m_settings)))
    , m_first_camera(request.camera)
    , m_viewport(request.render.spp, request.render.filter, threads, Window::wake)
    , m_workshop(request, Window::wake)
    , m_exposes(!request.exposure_given)
{
}

bool App::build(std::string& error)
{
    if (!m_viewport.build(m_workshop.request().filter.colorconfig, error))
        return false;
    // What was remembered may be of another config.
    std::string unknown;
    DisplayChoice choice = m_state.display;
    if (!m_workshop.request().display_given && !m_viewport.config().settle(choice, unknown))
        m_state.display = {};
    return m_workshop.request().display_given ? m_viewport.config().settle(choice, error) : true;
}

void App::open(const std::string& path)
{
    std::string error;
    m_news = format("open: {}", path);
    if (!m_workshop.open(path, error))
        m_news = error;
    m_frames_due = 3;
}

void App::reset_camera()
{
    m_state.camera = m_first_camera;
    m_state.pan = Imath::V2d(0);
    m_state.turn = 0;
}

void App::take_results()
{
    std::string problem;
    MeshPointer mesh;
    MapPointer map;
    LightPointer light;
    if (m_workshop.take_mesh(mesh, problem)) {
        remember_file(m_settings.recent_mesh, mesh->recipe.mesh);
        m_viewport.set_mesh(mesh);
    }
    if (m_workshop.take_map(map, problem))
        m_viewport.set_map(map);
    if (m_workshop.take_light(light, problem)) {
        remember_file(m_settings.recent_environment, light->path);
        m_viewport.set_light(light);
    }
    for (const std::string& warning : m_workshop.take_warnings())
        m_news = "warning: " + warning;
    if (!problem.empty())
        m_news = problem;
    m_workshop.bake_for(m_state.light.model);
    const MapPointer& seen = m_viewport.renderer().map();
    const bool wants_suns = m_state.trace.suns != "off";
    const std::string reason = seen && m_state.trace.has_any() ? untraceable_reason(seen->image.spec()) : std::string();
    if (!reason.empty())
        m_news = "suns stay in the environment, and no light bounces: " + reason;
    m_workshop.split_suns(wants_suns && reason.empty());
}

void App::handle_mouse()
{
    const ImGuiIO& io = ImGui::GetIO();
    const bool is_any_down = io.MouseDown[0] || io.MouseDown[1] || io.MouseDown[2];
    if (!is_any_down) {
        m_is_dragging = m_drags_wipe = false;
    } else if (!m_is_dragging && !io.WantCaptureMouse) {
        m_is_dragging = true;
        m_drags_wipe = !m_state.second.empty() && io.MouseDown[0]
            && std::abs(io.MousePos.x - float(m_state.wipe) * io.DisplaySize.x) <= kNearLine;
    }
    if (!io.WantCaptureMouse && io.MouseWheel != 0)
        zoom(m_state, double(io.MouseWheel));
    const double dx = double(io.MouseDelta.x), dy = double(io.MouseDelta.y);
    if (!m_is_dragging || (dx == 0 && dy == 0))
        return;
    if (m_drags_wipe)
        m_state.wipe = std::clamp(double(io.MousePos.x / std::max(1.0f, io.DisplaySize.x)), 0.0, 1.0);
    else if (io.MouseDown[2])
        pan_camera(m_state, dx, dy, int(io.DisplaySize.y));
    else if (io.MouseDown[1])
        turn_camera(m_state, dx, dy);
    else if (io.KeyShift)
        turn_environment(m_state, dx);
    else
        turn_object(m_state, dx, dy);
}

void App::find_cursor()
{
    const ImGuiIO& io = ImGui::GetIO();
    m_cursor = {};
    const MeshPointer& mesh = m_viewport.renderer().mesh();
    if (!mesh || io.WantCaptureMouse || m_is_dragging || !ImGui::IsMousePosValid())
        return;
    const double scale = m_window.scale();
    m_cursor = texel_under(*mesh, m_viewport.renderer().map().get(), m_viewport.camera(), double(io.MousePos.x) * scale,
                           double(io.MousePos.y) * scale, m_window.width(), m_window.height());
}

// The mean luminance of what the mesh covers of the texture becomes middle grey.
void App::expose()
{
    const Renderer& renderer = m_viewport.renderer();
    if (!m_exposes || m_viewport.is_tracing() || !renderer.map() || !renderer.light() || !renderer.has_texture(0)
        || m_state.show != "lit")
        return;
    OIIO::ImageSpec spec;
    tag_scene_linear(spec, renderer.light()->light.space);
    const std::array<double, 3> weights = luminance_weights(spec);
    const std::vector<float> texels = renderer.read_texture(0);
    double sum = 0, covered = 0;
    for (size_t i = 0; i < texels.size(); i += 4)
        if (texels[i + 3] == 1) {
            sum += weights[0] * texels[i] + weights[1] * texels[i + 1] + weights[2] * texels[i + 2];
            ++covered;
        }
    if (!(sum > 0))
        return;
    m_state.light.exposure = std::round(100 * GrayExposure::of(sum / covered).stops) / 100;
    m_exposes = false;
    m_frames_due = std::max(m_frames_due, 1);
}

void App::take_screenshot()
{
    std::string path, error;
    for (int i = 1; path.empty() || OIIO::Filesystem::exists(path); ++i)
        path = format("vmview_{:04}.png", i);
    m_news = write_picture(m_viewport.screenshot(), path, error) ? format("screenshot: {}", path) : error;
}

void App::run_once()
{
    for (const std::string& path : m_window.take_dropped())
        open(path);
    take_results();
    m_window.begin_frame();
    handle_mouse();
    const int width = m_window.width(), height = m_window.height();
    m_viewport.update(m_state, width, height, m_is_dragging);
    expose();
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    m_viewport.show(width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    find_cursor();
    draw_menus(*this);
    draw_panels(*this);
    const std::string mesh = m_workshop.request().mesh.mesh;
    const std::string title = mesh.empty() ? "vmview" : format("{} - vmview", OIIO::Filesystem::filename(mesh));
    if (title != m_title)
        m_window.set_title(m_title = title);
    m_window.end_frame();
    m_frames_due = std::max(0, m_frames_due - 1);
}

void App::run()
{
    while (!m_window.should_close() && !interrupted()) {
        run_once();
        const bool is_busy = m_frames_due > 0 || m_viewport.has_more();
        m_window.wait_for_events(is_busy ? 0 : 0.5);
        // ImGui settles within a few frames after something happened.
        if (!is_busy)
            m_frames_due = 3;
    }
    // Nothing is left behind: work stops at once, and no file is open.
    m_workshop.stop();
    m_viewport.stop();
}

bool App::keep_settings(std::string& error) const
{
    Settings settings = m_settings;
    m_window.get_size(settings.window.width, settings.window.height);
    settings.model = m_state.light.model;
    settings.display = m_state.display.display;
    settings.view = m_state.display.view;
    settings.look = m_state.display.look;
    return write_settings(settings, m_settings_path, error);
}

bool run_window(const Request& request, int threads, std::string& error)
{
    const Size last = read_settings(settings_path()).window;
    const Size size = request.size_given ? request.render.size : last;
    const auto window = Window::open(size.width, size.height, "vmview", request.view.gl_debug, error);
    if (!window)
        return false;
    App app(request, *window, threads);
    if (!app.build(error))
        return false;
    app.run();
    error = gl_fault();
    if (!error.empty()) {
        error = format("OpenGL: {}", error);
        return false;
    }
    std::string ignored; // a home that cannot be written is no reason to fail
    app.keep_settings(ignored);
    return true;
}

} // namespace vmlight::view
