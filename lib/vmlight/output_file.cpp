// SPDX-License-Identifier: Apache-2.0
#include <vmlight/output_file.h>

#include <vmlight/interrupt.h>

#include <OpenImageIO/strutil.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <unistd.h>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

std::string folder_of(const std::string& path)
{
    const std::string folder = OIIO::Filesystem::parent_path(path);
    return folder.empty() ? "." : folder;
}

// Where the links lead that `path` may be, whether there is a file or not; "" if in circles.
std::string link_target(std::string path)
{
    constexpr int kMostLinks = 40; // as the system's
    std::error_code fault;
    for (int link = 0; link < kMostLinks; ++link) {
        const auto target = std::filesystem::read_symlink(path, fault);
        if (fault)
            return path;
        path = target.is_absolute() ? target.string() : folder_of(path) + "/" + target.string();
    }
    return "";
}

// A name beside `path` that no file has.
std::string temporary_path(const std::string& path)
{
    // Cut, since the file system may take no longer names than this. Every % becomes a random digit: not the folder's.
    const std::string name = OIIO::Filesystem::filename(path).substr(0, 200);
    return folder_of(path) + "/" + OIIO::Filesystem::unique_path("." + name + ".%%%%%%%%.part");
}

void flush_folder(const std::string& path)
{
    const int folder = ::open(path.c_str(), O_RDONLY);
    if (folder < 0)
        return;
    ::fsync(folder);
    ::close(folder);
}

// What keeps a file from being made at `path`, or "".
std::string trial_fault(const std::string& path)
{
    // Rights alone do not tell: some folders (/proc) take no files from anyone.
    const std::string trial = temporary_path(path);
    const WhileWriting there; // an interrupt waits for it to be gone
    const int file = ::open(trial.c_str(), O_CREAT | O_EXCL | O_WRONLY, 0600);
    if (file < 0)
        return std::strerror(errno);
    ::close(file);
    ::unlink(trial.c_str());
    return "";
}

std::string place_fault(const std::string& path, const std::string& target)
{
    const std::string folder = folder_of(target);
    if (!OIIO::Filesystem::is_directory(folder))
        return format("\"{}\": no folder \"{}\"", path, folder);
    const std::string fault = trial_fault(target);
    return fault.empty() ? "" : format("\"{}\": the folder \"{}\" cannot be written: {}", path, folder, fault);
}

} // namespace

std::string output_file_fault(const std::string& path)
{
    const std::string target = link_target(path);
    if (target.empty())
        return format("\"{}\": a link that leads in circles", path);
    if (OIIO::Filesystem::is_directory(target))
        return format("\"{}\": is a folder", path);
    if (OIIO::Filesystem::exists(target) && !OIIO::Filesystem::is_regular(target))
        return format("\"{}\": is a device or a pipe, which a file would replace", path);
    return place_fault(path, target);
}

std::string output_folder_fault(const std::string& path)
{
    if (OIIO::Filesystem::is_directory(path))
        return place_fault(path, path + "/report");
    if (OIIO::Filesystem::exists(path))
        return format("\"{}\": is a file, not a folder", path);
    std::string name = path;
    while (name.size() > 1 && name.back() == '/')
        name.pop_back();
    return place_fault(path, name);
}

bool write_file(const std::string& path, OIIO::string_view bytes, std::string& error)
{
    error = output_file_fault(path);
    if (!error.empty())
        return false;
    OutputFile file(path);
    file.write(bytes.data(), bytes.size());
    if (!file.keep())
        error = format("\"{}\": {}", path, file.reason());
    return error.empty();
}

OutputFile::OutputFile(const std::string& path)
    : OutputFile(link_target(path), temporary_path(link_target(path)))
{
}

OutputFile::OutputFile(const std::string& target, const std::string& temporary)
    : IOFile(temporary, Write)
    , m_target(target)
    , m_temporary(temporary)
{
    if (!opened())
        m_reason = error();
}

OutputFile::~OutputFile()
{
    if (!m_kept)
        OIIO::Filesystem::remove(m_temporary);
}

size_t OutputFile::write(const void* bytes, size_t size)
{
    if (sound() && IOFile::write(bytes, size) != size)
        m_reason = std::strerror(errno);
    return size;
}

bool OutputFile::keep()
{
    // The file's bytes must be on the disk before its name is, or a crash could leave the name with nothing behind it.
    if (sound() && (std::fflush(handle()) != 0 || ::fsync(::fileno(handle())) != 0))
        m_reason = std::strerror(errno);
    if (!sound())
        return false;
    close();
    if (std::rename(m_temporary.c_str(), m_target.c_str()) != 0)
        m_reason = std::strerror(errno);
    m_kept = sound();
    if (m_kept)
        flush_folder(folder_of(m_target));
    return m_kept;
}

} // namespace vmlight
