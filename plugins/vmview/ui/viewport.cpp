// SPDX-License-Identifier: Apache-2.0
#include "viewport.h"

#include "../render/lighting.h"
#include "../scene/loading.h"
#include "params_key.h"

#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>

namespace vmlight::view {
namespace {

// A drag stays smooth up to this.
constexpr double kSlowFrame = 33;

std::string camera_key(const Camera& c)
{
    std::string key;
    for (const Imath::V3d& v : { c.position, c.right, c.up, c.forward })
        key += format("{} {} {} ", v.x, v.y, v.z);
    return key + format("{} {} {}", c.half_width, c.half_height, c.is_orthographic);
}

} // namespace

Viewport::Viewport(int spp, const std::string& filter, int threads, std::function<void()> wake)
    : m_spp(spp)
    , m_threads(threads)
    , m_filter(filter)
    , m_slots { { Slot(wake), Slot(wake) } }
    , m_tracing(threads, wake)
{
}

bool Viewport::build(const std::string& colorconfig, std::string& error)
{
    m_no_vertices = make_vertex_array();
    return m_renderer.build(error) && m_config.open(colorconfig, error)
        && m_data_display.build(m_config.no_change(), error);
}

void Viewport::set_mesh(MeshPointer mesh)
{
    stop();
    ++m_generation;
    m_map_problem.clear();
    m_renderer.set_map(nullptr, m_map_problem);
    load_mesh(mesh);
}

// White where the graphics card has no room for its textures; nothing where there is none for the mesh itself.
void Viewport::load_mesh(MeshPointer mesh)
{
    m_mesh_problem.clear();
    std::string ignored;
    if (!m_renderer.set_mesh(mesh, !m_is_white, m_mesh_problem) && !m_renderer.set_mesh(mesh, false, ignored))
        m_renderer.set_mesh(nullptr, false, ignored);
}

void Viewport::set_map(MapPointer map)
{
    stop();
    ++m_generation;
    m_map_problem.clear();
    m_renderer.set_map(std::move(map), m_map_problem);
}

void Viewport::set_light(LightPointer light)
{
    stop();
    ++m_generation;
    for (int slot = 0; slot < 2; ++slot)
        m_renderer.add_light(slot, {});
    m_light_problem.clear();
    m_renderer.set_light(std::move(light), m_light_problem);
}

bool Viewport::refresh_display(const ViewState& state)
{
    DisplayChoice choice = state.display;
    if (!m_config.settle(choice, m_problem))
        return false;
    if (choice == m_choice)
        return true;
    const auto processor = m_config.processor(choice, m_problem);
    if (!processor || !m_light_display.build(processor, m_problem))
        return false;
    m_choice = choice;
    return true;
}

void Viewport::update(const ViewState& state, int width, int height, bool is_dragging)
{
    m_has_more = false;
    if (state.is_white != m_is_white) {
        m_is_white = state.is_white;
        load_mesh(m_renderer.mesh());
        ++m_generation;
    }
    m_problem = !m_mesh_problem.empty() ? m_mesh_problem : !m_map_problem.empty() ? m_map_problem : m_light_problem;
    glBindVertexArray(m_no_vertices.get());
    const bool has_second = !state.second.empty() && is_light(state.show);
    m_tracing.update(m_renderer, state, m_generation, m_is_white, m_problem);
    bool changed = refresh_texture(0, state, state.show, state.light.model);
    if (has_second)
        changed |= refresh_texture(1, state, state.show, state.second);
    else
        stop(m_slots[1]);
    if (!refresh_display(state))
        return;

    PictureParams params;
    LightmapParams light;
    const MeshPointer& mesh = m_renderer.mesh();
    if (mesh)
        m_camera = camera_of(state, *mesh->mesh, mesh->subject, double(width) / height);
    params.view.camera = m_camera;
    params.has_background = state.has_background;
    params.show = surface_show(state.show);
    params.wipe = has_second && m_renderer.has_texture(1) ? state.wipe : 1;
    if (!light_params(light, state.light, state.turn, m_problem)
        || !lightmap_rotation(params.to_environment, light, m_problem))
        return;
    if (!is_dragging)
        m_scale = 1;
    else if (m_frame_ms > kSlowFrame && m_scale == 1)
        m_scale = 0.5;
    const int across = std::max(1, int(std::lround(width * m_scale)));
    const int down = std::max(1, int(std::lround(height * m_scale)));
    const int spp = is_dragging ? 1 : m_spp;
    const std::string key = format("{}|{}|{}|{}x{}|{}|{}|{}|{}|", m_generation, m_slots[0].key, m_slots[1].key, across,
                                   down, spp, params.has_background, int(params.show), params.wipe)
        + camera_key(m_camera) + key_of(light);
    if (changed || key != m_picture_key) {
        m_picture_key = key;
        m_sum.start(across, down, spp, m_filter);
        m_shown_key.clear();
    }
    if (!m_sum.is_complete()) {
        const Stopwatch timer;
        m_sum.add(m_renderer, params);
        m_shown_key.clear();
        glFinish();
        if (m_scale == 1)
            m_frame_ms = 1000 * timer();
    }
    m_has_more = !m_sum.is_complete();
    const std::string shown = format("{}|{}|{}|{}|{}", state.light.exposure, m_choice.display, m_choice.view,
                                     m_choice.look, is_light(state.show));
    if (shown == m_shown_key)
        return;
    m_shown_key = shown;
    if (m_shown.width() != across || m_shown.height() != down)
        m_shown = Framebuffer(across, down, GL_RGBA8, false);
    m_shown.bind();
    glBindVertexArray(m_no_vertices.get());
    if (is_light(state.show))
        m_light_display.run(m_sum.mean(), float(std::exp2(state.light.exposure)), across, down);
    else
        m_data_display.run(m_sum.mean(), 1, across, down);
}

void Viewport::show(int width, int height) const
{
    if (!m_shown)
        return;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, m_shown.get());
    glBlitFramebuffer(0, 0, m_shown.width(), m_shown.height(), 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                      m_shown.width() == width ? GL_NEAREST : GL_LINEAR);
}

OIIO::ImageBuf Viewport::screenshot() const
{
    return OIIO::ImageBufAlgo::channels(read_image_of(m_shown), 3, {});
}

bool Viewport::texel(size_t figure, int x, int y, float* rgb) const
{
    if (!m_renderer.has_texture(0))
        return false;
    float rgba[4];
    m_renderer.read_texel(0, x, y, rgba, figure);
    for (int c = 0; c < 3; ++c)
        rgb[c] = rgba[3] > 0 ? rgba[c] / rgba[3] : 0;
    return true;
}

} // namespace vmlight::view
