// SPDX-License-Identifier: Apache-2.0
/// The picture in the window: made anew only where something has changed, antialiased sample by sample while nothing
/// does, and at half the resolution while the mouse drags, if that keeps it quick. Suns and the bounce are traced in
/// the background, one rotation after the other: while the light turns, the last that is done is shown.
#pragma once

#include "../display/display_pass.h"
#include "../render/picture.h"
#include "light_jobs.h"
#include "light_tracing.h"
#include "view_state.h"

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <memory>
#include <string>

namespace vmlight::view {

class Viewport
{
public:
    /// @param wake     called from other threads when there is something new to draw
    Viewport(int spp, const std::string& filter, int threads, std::function<void()> wake);

    /// Compile the shaders and read the config. False, with the reason in `error`.
    bool build(const std::string& colorconfig, std::string& error);

    // As those of Renderer.
    void set_mesh(MeshPointer mesh);
    void set_map(MapPointer map);
    void set_light(LightPointer light);
    const Renderer& renderer() const { return m_renderer; }
    const DisplayConfig& config() const { return m_config; }

    /// Bring the picture up to date for `state` in `width` x `height` pixels, as far as one frame allows.
    void update(const ViewState& state, int width, int height, bool is_dragging);
    /// Whether another update() would change the picture.
    bool has_more() const { return m_has_more; }
    /// Copy the picture to the framebuffer that is bound.
    void show(int width, int height) const;

    /// The picture as it is shown: R, G, B, rows from the top.
    OIIO::ImageBuf screenshot() const;
    /// The light or colour of a texel of the left texture, and whether there is one.
    bool texel(size_t figure, int x, int y, float* rgb) const;
    const Camera& camera() const { return m_camera; }
    /// The model that lights the left half; "" for none.
    const std::string& model() const { return m_slots[0].used; }

    /// Why the picture is not what was asked for, as long as it is not, or "".
    const std::string& problem() const { return m_problem; }
    /// What goes on in the background, or "": "reference: 64 rays".
    std::string activity() const;
    /// Whether light is still to be traced.
    bool is_tracing() const { return m_tracing.is_tracing(); }
    /// Stop all background work.
    void stop();

private:
    // What a texture was made for; and who makes it, if the graphics card does not.
    struct Slot
    {
        explicit Slot(std::function<void()> wake)
            : job(std::move(wake))
        {
        }
        std::string key, used, activity, beside; ///< the last of what is beside it
        std::string problem; ///< why it is black
        ImageJob job;
        std::vector<float> rest; ///< what the job made, before light is added to it; empty: the graphics card lights
        int added = 0; ///< m_tracing.count() when the texture was made
    };
    static void start(Slot& slot, const std::string& activity, ImageJob::Work work);
    static void stop(Slot& slot);
    bool refresh_texture(int index, const ViewState& state, const std::string& word, const std::string& model);
    void load_mesh(MeshPointer mesh);
    bool show_or_clear(size_t figure, int index, const std::string& word, const LightmapParams& params);
    bool clear(size_t figure, int index, const std::string& reason);
    bool refresh_display(const ViewState& state);

    const int m_spp, m_threads;
    const std::string m_filter;
    Renderer m_renderer;
    DisplayConfig m_config;
    DisplayPass m_light_display, m_data_display;
    DisplayChoice m_choice;
    std::array<Slot, 2> m_slots;
    LightTracing m_tracing;
    bool m_is_white = false;
    PictureSum m_sum;
    Framebuffer m_shown;
    VertexArray m_no_vertices;
    Camera m_camera;
    std::string m_picture_key, m_shown_key, m_problem;
    std::string m_mesh_problem, m_map_problem, m_light_problem; // what the graphics card has no room for
    double m_scale = 1, m_frame_ms = 0;
    int m_generation = 0; // of what is on the graphics card
    bool m_has_more = false;
};

} // namespace vmlight::view
