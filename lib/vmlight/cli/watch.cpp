// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/watch.h>

#include <vmlight/base/file_watch.h>
#include <vmlight/base/format.h>
#include <vmlight/base/interrupt.h>
#include <vmlight/base/text_format.h>
#include <vmlight/cli/exit_code.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace vmlight {
namespace {

constexpr size_t kMostNamed = 3;

bool is_same_file(const std::string& a, const std::string& b)
{
    std::error_code ignored;
    return a == b || std::filesystem::equivalent(a, b, ignored);
}

// "hero.lightmap, studio.hdr and 2 more": without folders, of which the user knows.
std::string names_text(const std::vector<std::string>& paths)
{
    std::vector<std::string> names;
    for (const std::string& path : paths)
        if (names.size() < kMostNamed)
            names.push_back(std::filesystem::path(path).filename().string());
    std::string text = printable_line(OIIO::Strutil::join(names, ", "));
    if (paths.size() > kMostNamed)
        text += format(" and {} more", paths.size() - kMostNamed);
    return text;
}

void print(const std::string& line)
{
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
}

} // namespace

void Watch::add_flag(StageMain& stage)
{
    m_name = stage.name();
    stage.option("watch", "",
                 "Keep running, and remake the image whenever one of its input files changes: a recipe, the map, the "
                 "light. Uncompressed unless --compression zip is given. Ctrl-C stops it",
                 [this, &stage](auto, auto&) {
                     stage.stay_up(m_warned);
                     return m_is_given = true;
                 });
    stage.check([this] { return m_is_given ? FileWatch::fault() : ""; });
    if (m_is_again)
        stage.repeat();
}

std::string Watch::output_fault(const std::string& output) const
{
    if (!m_is_given)
        return "";
    for (const FileStamp& file : StampLog::files())
        if (is_same_file(file.path, output))
            return format("\"{}\": the image is made of this file: --watch would never come to an end", output);
    return "";
}

void Watch::made(const StageMain& stage, const std::string& output)
{
    if (!m_is_given || stage.is_quiet())
        return;
    const std::string name = printable_line(output);
    if (m_is_again)
        print(format("watch: {} changed: {} in {:.0f} ms", names_text(m_changed), name, 1e3 * m_timer()));
    else
        print(format("watch: {}; Ctrl-C ends",
                     count_text(int64_t(StampLog::files().size()), "file is watched", "files are watched")));
}

std::vector<std::string> Watch::changed_files() const
{
    std::vector<std::string> changed;
    for (const FileStamp& file : m_files) {
        std::string now, ignored;
        if ((stamp_file(now, file.path, ignored) ? now : "") != file.stamp)
            changed.push_back(file.path);
    }
    return changed;
}

int Watch::run(const std::function<int()>& once)
{
    const StampLog log;
    FileWatch watch;
    int code = once();
    if (!m_is_given || code != int(ExitCode::Done))
        return code;
    const auto complain = [this](const std::string& error) {
        std::fprintf(stderr, "%s ERROR: %s\n", m_name.c_str(), printable_line(error).c_str());
        return int(ExitCode::Failed);
    };
    for (m_is_again = true; !interrupted(); code = once()) {
        if (code != int(ExitCode::Done))
            std::fprintf(stderr, "%s: the image stays as it was, until a file changes again\n", m_name.c_str());
        m_files = StampLog::files();
        std::vector<std::string> paths;
        for (const FileStamp& file : m_files)
            paths.push_back(file.path);
        std::string error;
        if (!watch.follow(paths, error))
            return complain(error);
        // Only now, so that no change is missed.
        while ((m_changed = changed_files()).empty())
            watch.wait();
        StampLog::clear();
        m_timer.lap();
    }
    return code == int(ExitCode::Done) ? complain("interrupted") : code;
}

} // namespace vmlight
