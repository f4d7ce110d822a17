// SPDX-License-Identifier: Apache-2.0
/// The window: its state, what it shows, and what goes on behind it.
#pragma once

#include "../gl/window.h"
#include "../settings.h"
#include "cursor.h"
#include "viewport.h"
#include "workshop.h"

#include <memory>
#include <string>

namespace vmlight::view {

class App
{
public:
    App(const Request& request, Window& window, int threads);

    /// Compile the shaders, and start to read what the request names. False, with the reason in `error`.
    bool build(std::string& error);
    /// One turn: take what is ready, draw, and show it.
    void run_once();
    /// Run until the window is closed.
    void run();
    /// What a file that is dropped, or chosen in a menu, does. A file that cannot be shown is reported in the window.
    void open(const std::string& path);
    /// Keep the settings for the next run. False, with the reason in `error`, if they cannot be written.
    bool keep_settings(std::string& error) const;

    // For menus and panels.
    ViewState& state() { return m_state; }
    Viewport& viewport() { return m_viewport; }
    Window& window() { return m_window; }
    const Workshop& workshop() const { return m_workshop; }
    Settings& settings() { return m_settings; }
    const CursorTexel& cursor() const { return m_cursor; }
    void take_screenshot();
    void expose_automatically() { m_exposes = true; }
    void reset_camera();
    /// Say something in the status line: what was done, or what is wrong.
    void tell(const std::string& line) { m_news = line; }
    const std::string& news() const { return m_news; }

private:
    void take_results();
    void handle_mouse();
    void find_cursor();
    void expose();

    Window& m_window;
    const std::string m_settings_path;
    Settings m_settings;
    ViewState m_state;
    const CameraParams m_first_camera;
    Viewport m_viewport;
    Workshop m_workshop;
    CursorTexel m_cursor;
    std::string m_news, m_title;
    bool m_exposes = false, m_is_dragging = false, m_drags_wipe = false;
    int m_frames_due = 3;
};

/// Open a window for `request` and run until it is closed. False, with the reason in `error`, on failure.
bool run_window(const Request& request, int threads, std::string& error);

} // namespace vmlight::view
