// SPDX-License-Identifier: Apache-2.0
/// What the window remembers from run to run, in vmlight/vmview.conf of $XDG_CONFIG_HOME, or of ~/.config.
#pragma once

#include <vmlight/base/params.h>

#include <string>
#include <vector>

namespace vmlight::view {

struct Settings
{
    Size window { 1280, 720 };
    /// The last ones opened, newest first.
    std::vector<std::string> recent_mesh, recent_environment;
    std::string model = "auto", display, view, look;

    template <class Visit> void visit(Visit&& field)
    {
        field("window", window, SizeRange { 16384, 1 }, "");
        field("recent_mesh", recent_mesh, Paths {}, "");
        field("recent_environment", recent_environment, Paths {}, "");
        field("model", model, Text {}, "");
        field("display", display, Text {}, "");
        field("view", view, Text {}, "");
        field("look", look, Text {}, "");
    }
};

/// Where they are kept; "" if there is no home.
std::string settings_path();

/// Read them; what is missing or cannot be read has its default.
Settings read_settings(const std::string& path);
/// Write them, with folders. False, with the reason in `error`, on failure.
bool write_settings(const Settings& settings, const std::string& path, std::string& error);

/// Put `path` first in a list of recent files, which has each at most once, and ten at most.
void remember_file(std::vector<std::string>& recent, const std::string& path);

} // namespace vmlight::view
