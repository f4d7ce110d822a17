// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/output_file.h>

#include <vmlight/base/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <sys/stat.h>
#include <unistd.h>

namespace vmlight {
namespace {

// Follows symbolic links, dangling ones too; "" if they form a loop.
std::string link_target(std::string path)
{
    constexpr int kMaxLinks = 40; // Linux's limit
    std::error_code fault;
    for (int link = 0; link < kMaxLinks; ++link) {
        const auto target = std::filesystem::read_symlink(path, fault);
        if (fault)
            return path;
        path = target.is_absolute() ? target.string() : parent_folder(path) + "/" + target.string();
    }
    return "";
}

std::string folder_fault(const std::string& path, const std::string& target)
{
    const std::string folder = parent_folder(target);
    if (!OIIO::Filesystem::is_directory(folder))
        return format("\"{}\": no such folder: \"{}\"", path, folder);
    // Permissions are not enough: some folders (/proc) accept no files from anyone.
    const std::string fault = TemporaryFile(target, TemporaryFileKind::Unnamed).reason();
    return fault.empty() ? "" : format("\"{}\": folder \"{}\" is not writable: {}", path, folder, fault);
}

} // namespace

std::string output_file_fault(const std::string& path)
{
    const std::string target = link_target(path);
    if (target.empty())
        return format("\"{}\": too many levels of symbolic links", path);
    struct stat old;
    if (::stat(target.c_str(), &old) != 0)
        return errno == ENOENT || errno == ENOTDIR ? folder_fault(path, target)
                                                   : format("\"{}\": {}", path, std::strerror(errno));
    if (S_ISDIR(old.st_mode))
        return format("\"{}\": is a folder", path);
    if (!S_ISREG(old.st_mode))
        return format("\"{}\": is a device or a pipe, not a file", path);
    if (::access(target.c_str(), W_OK) != 0) // renaming would replace it all the same
        return format("\"{}\": not writable: {}", path, std::strerror(errno));
    return folder_fault(path, target);
}

std::string output_folder_fault(const std::string& path)
{
    if (OIIO::Filesystem::is_directory(path))
        return folder_fault(path, path + "/report");
    if (OIIO::Filesystem::exists(path))
        return format("\"{}\": is a file, not a folder", path);
    std::string name = path;
    while (name.size() > 1 && name.back() == '/')
        name.pop_back();
    return folder_fault(path, name);
}

bool write_file(const std::string& path, OIIO::string_view bytes, std::string& error)
{
    error = output_file_fault(path);
    if (!error.empty())
        return false;
    OutputFile file(path);
    file.write(bytes.data(), bytes.size());
    if (!file.commit())
        error = format("\"{}\": {}", path, file.reason());
    return error.empty();
}

OutputFile::OutputFile(const std::string& path, TemporaryFileKind kind)
    : IOProxy(path, Write)
    , m_file(std::make_unique<TemporaryFile>(link_target(path), kind))
    , m_reason(m_file->reason())
{
    remove_stale_temporaries(link_target(path));
}

OutputFile::~OutputFile() = default;

void OutputFile::fail(const std::string& reason)
{
    if (ok())
        m_reason = reason;
}

bool OutputFile::seek(int64_t offset)
{
    if (offset < 0)
        fail(format("a position before the start of the file ({})", offset));
    else
        m_pos = offset;
    return true;
}

size_t OutputFile::read(void* bytes, size_t size)
{
    const size_t count = pread(bytes, size, m_pos);
    m_pos += int64_t(count);
    return count;
}

size_t OutputFile::write(const void* bytes, size_t size)
{
    pwrite(bytes, size, m_pos);
    m_pos += int64_t(size);
    return size;
}

size_t OutputFile::pread(void* bytes, size_t size, int64_t offset)
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    size_t done = 0;
    while (ok() && done < size) {
        const ssize_t count
            = ::pread(m_file->file(), static_cast<char*>(bytes) + done, size - done, offset + int64_t(done));
        if (count < 0 && errno != EINTR)
            fail(std::strerror(errno));
        if (count == 0)
            break;
        done += count > 0 ? size_t(count) : 0;
    }
    return done;
}

size_t OutputFile::pwrite(const void* bytes, size_t size, int64_t offset)
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    size_t done = 0;
    while (ok() && done < size) {
        const ssize_t count
            = ::pwrite(m_file->file(), static_cast<const char*>(bytes) + done, size - done, offset + int64_t(done));
        if (count < 0 && errno != EINTR)
            fail(std::strerror(errno));
        else if (count == 0)
            fail("the disk takes no more bytes");
        done += count > 0 ? size_t(count) : 0;
    }
    m_size = std::max(m_size, size_t(offset) + size);
    return size;
}

bool OutputFile::commit()
{
    struct stat status;
    if (ok() && ::fstat(m_file->file(), &status) != 0)
        fail(std::strerror(errno));
    else if (ok() && m_size > 0 && size_t(status.st_size) != m_size)
        fail(format("{} bytes were written, but the file has {}", m_size, int64_t(status.st_size)));
    if (ok() && !m_file->commit())
        fail(std::strerror(errno));
    return ok();
}

} // namespace vmlight
