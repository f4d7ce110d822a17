// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/output_file.h>

#include <OpenImageIO/strutil.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <sys/stat.h>
#include <unistd.h>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

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

std::string place_fault(const std::string& path, const std::string& target)
{
    const std::string folder = folder_of(target);
    if (!OIIO::Filesystem::is_directory(folder))
        return format("\"{}\": no folder \"{}\"", path, folder);
    // Rights alone do not tell: some folders (/proc) take no files from anyone.
    const std::string fault = PartFile(target, PartKind::Nameless).reason();
    return fault.empty() ? "" : format("\"{}\": the folder \"{}\" cannot be written: {}", path, folder, fault);
}

} // namespace

std::string output_file_fault(const std::string& path)
{
    const std::string target = link_target(path);
    if (target.empty())
        return format("\"{}\": a link that leads in circles", path);
    struct stat old;
    if (::stat(target.c_str(), &old) != 0)
        return errno == ENOENT || errno == ENOTDIR ? place_fault(path, target)
                                                   : format("\"{}\": {}", path, std::strerror(errno));
    if (S_ISDIR(old.st_mode))
        return format("\"{}\": is a folder", path);
    if (!S_ISREG(old.st_mode))
        return format("\"{}\": is a device or a pipe, which a file would replace", path);
    if (::access(target.c_str(), W_OK) != 0) // the folder would let it be replaced
        return format("\"{}\": cannot be written: {}", path, std::strerror(errno));
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

OutputFile::OutputFile(const std::string& path, PartKind kind)
    : OutputFile(std::make_unique<PartFile>(link_target(path), kind))
{
    remove_abandoned_parts(link_target(path));
}

OutputFile::OutputFile(std::unique_ptr<PartFile> part)
    : IOFile(part->stream(), Write)
    , m_part(std::move(part))
    , m_reason(m_part->reason())
{
}

OutputFile::~OutputFile() = default;

size_t OutputFile::write(const void* bytes, size_t size)
{
    if (sound() && IOFile::write(bytes, size) != size)
        m_reason = std::strerror(errno);
    return size;
}

bool OutputFile::keep()
{
    if (sound() && !m_part->place())
        m_reason = std::strerror(errno);
    return sound();
}

} // namespace vmlight
