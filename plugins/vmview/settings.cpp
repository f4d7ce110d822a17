// SPDX-License-Identifier: Apache-2.0
#include "settings.h"

#include <vmlight/base/output_file.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>
#include <OpenImageIO/sysutil.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>

namespace vmlight::view {
namespace {

constexpr size_t kMostRecent = 10;

} // namespace

std::string settings_path()
{
    const std::string home = OIIO::Sysutil::getenv("HOME");
    std::string folder = OIIO::Sysutil::getenv("XDG_CONFIG_HOME");
    if (folder.empty() && !home.empty())
        folder = home + "/.config";
    return folder.empty() ? "" : folder + "/vmlight/vmview.conf";
}

Settings read_settings(const std::string& path)
{
    Settings settings;
    std::string text;
    if (path.empty() || !OIIO::Filesystem::exists(path) || !OIIO::Filesystem::read_text_file(path, text))
        return settings;
    std::map<std::string, std::string> values; // of lists: one a line
    for (const std::string& line : OIIO::Strutil::splits(text, "\n")) {
        const size_t equals = line.find(" = ");
        if (equals == std::string::npos)
            continue;
        std::string& value = values[line.substr(0, equals)];
        value += (value.empty() ? "" : "\n") + line.substr(equals + 3);
    }
    for (const auto& [name, value] : values) {
        std::string ignored; // another version's, or somebody's
        set_param(settings, name, value, ignored);
    }
    return settings;
}

bool write_settings(const Settings& settings, const std::string& path, std::string& error)
{
    if (path.empty())
        return true;
    std::error_code failed;
    std::filesystem::create_directories(std::filesystem::path(path).parent_path(), failed);
    std::string text;
    Settings copy = settings;
    copy.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        for (const std::string& line : OIIO::Strutil::splits(value_text(value, allowed), "\n"))
            text += std::string(name) + " = " + line + "\n";
    });
    return write_file(path, text, error);
}

void remember_file(std::vector<std::string>& recent, const std::string& path)
{
    std::error_code failed;
    const std::filesystem::path whole = std::filesystem::absolute(path, failed);
    const std::string name = failed ? path : whole.lexically_normal().string();
    if (name.find('\n') != std::string::npos) // a line of the file holds one
        return;
    recent.erase(std::remove(recent.begin(), recent.end(), name), recent.end());
    recent.insert(recent.begin(), name);
    recent.resize(std::min(recent.size(), kMostRecent));
}

} // namespace vmlight::view
