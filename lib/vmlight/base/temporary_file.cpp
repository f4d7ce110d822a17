// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/temporary_file.h>

#include <vmlight/base/format.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vmlight {
namespace {

constexpr const char* kDigits = "%%%%%%%%"; // unique_path() replaces each by a random hexadecimal digit
constexpr const char* kEnding = ".part";
constexpr mode_t kAnyone = 0666; // less the umask

// The start of hidden names of `name`, cut to what file systems allow.
std::string hidden_prefix(const std::string& name)
{
    constexpr size_t kLongest = 200;
    size_t length = std::min(name.size(), kLongest);
    const auto is_continuation = [&](size_t i) { return i < name.size() && (name[i] & 0xC0) == 0x80; }; // UTF-8
    while (length > 0 && is_continuation(length))
        --length;
    return "." + name.substr(0, length) + ".";
}

std::string hidden_name(const std::string& name)
{
    // unique_path() must not see the name: it may contain a %.
    return hidden_prefix(name) + OIIO::Filesystem::unique_path(kDigits) + kEnding;
}

bool is_hidden_name_of(const std::string& entry, const std::string& name)
{
    const std::string prefix = hidden_prefix(name);
    const size_t digits = std::strlen(kDigits);
    return entry.size() == prefix.size() + digits + std::strlen(kEnding) && OIIO::Strutil::starts_with(entry, prefix)
        && OIIO::Strutil::ends_with(entry, kEnding)
        && entry.find_first_not_of("0123456789abcdef", prefix.size()) == prefix.size() + digits;
}

int open_folder(const std::string& target)
{
    // Relative to a descriptor, file names are short however long the folder's path is.
    return ::open(parent_folder(target).c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
}

std::string link_of(int file)
{
    return format("/proc/self/fd/{}", file);
}

} // namespace

std::string parent_folder(const std::string& path)
{
    const std::string folder = OIIO::Filesystem::parent_path(path);
    return folder.empty() ? "." : folder;
}

TemporaryFile::TemporaryFile(const std::string& target, TemporaryFileKind kind)
    : m_target(target)
    , m_name(OIIO::Filesystem::filename(target))
    , m_folder(open_folder(target))
{
    int file = m_folder >= 0 && kind == TemporaryFileKind::Unnamed ? open_unnamed() : -1;
    if (m_folder >= 0 && file < 0)
        file = open_hidden();
    if (file < 0) {
        m_reason = std::strerror(errno);
        return;
    }
    m_file = file;
    struct stat old;
    if (::fstatat(m_folder, m_name.c_str(), &old, 0) == 0)
        ::fchmod(file, old.st_mode & 0777);
}

TemporaryFile::~TemporaryFile()
{
    if (!m_hidden_name.empty())
        ::unlinkat(m_folder, m_hidden_name.c_str(), 0);
    if (m_file >= 0)
        ::close(m_file);
    if (m_folder >= 0)
        ::close(m_folder);
}

int TemporaryFile::open_unnamed() const
{
    const int file = ::openat(m_folder, ".", O_TMPFILE | O_RDWR | O_CLOEXEC, kAnyone);
    if (file < 0)
        return -1;
    if (::access(link_of(file).c_str(), F_OK) == 0) {
        ::flock(file, LOCK_EX); // kept when it gets a name
        return file;
    }
    ::close(file);
    return -1;
}

int TemporaryFile::open_hidden()
{
    for (;;) {
        m_hidden_name = hidden_name(m_name);
        const int file = ::openat(m_folder, m_hidden_name.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, kAnyone);
        if (file < 0 && errno == EEXIST)
            continue;
        if (file < 0) {
            m_hidden_name.clear();
            return -1;
        }
        // Before it was locked, another process may have removed it as stale.
        struct stat status;
        ::flock(file, LOCK_EX);
        if (::fstat(file, &status) != 0 || status.st_nlink > 0)
            return file;
        ::close(file);
    }
}

bool TemporaryFile::give_hidden_name()
{
    int result;
    do {
        m_hidden_name = hidden_name(m_name);
        result = ::linkat(AT_FDCWD, link_of(m_file).c_str(), m_folder, m_hidden_name.c_str(), AT_SYMLINK_FOLLOW);
    } while (result != 0 && errno == EEXIST);
    if (result != 0)
        m_hidden_name.clear();
    return result == 0;
}

std::string TemporaryFile::path() const
{
    if (m_file < 0)
        return m_target;
    const std::string link = link_of(m_file);
    return m_hidden_name.empty() || ::access(link.c_str(), F_OK) == 0 ? link
                                                                      : parent_folder(m_target) + "/" + m_hidden_name;
}

bool TemporaryFile::commit()
{
    // The bytes must reach the disk before the name, or a crash could leave an empty file.
    if (::fsync(m_file) != 0)
        return false;
    // linkat() does not replace an existing file: link to a hidden name, then rename.
    const std::string link = link_of(m_file);
    const bool first
        = m_hidden_name.empty() && ::linkat(AT_FDCWD, link.c_str(), m_folder, m_name.c_str(), AT_SYMLINK_FOLLOW) == 0;
    if (!first) {
        if (m_hidden_name.empty() && (errno != EEXIST || !give_hidden_name()))
            return false;
        if (::renameat(m_folder, m_hidden_name.c_str(), m_folder, m_name.c_str()) != 0)
            return false;
        m_hidden_name.clear();
    }
    const int folder = ::openat(m_folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0)
        return true; // writable but not readable
    // Some file systems cannot flush a folder (EINVAL); that is no fault of the disk.
    const int fault = ::fsync(folder) == 0 ? 0 : errno;
    ::close(folder);
    errno = fault;
    return fault != EIO && fault != ENOSPC && fault != EDQUOT;
}

void remove_stale_temporaries(const std::string& target)
{
    const std::string name = OIIO::Filesystem::filename(target);
    const std::unique_ptr<DIR, int (*)(DIR*)> folder(::opendir(parent_folder(target).c_str()), ::closedir);
    while (const dirent* entry = folder ? ::readdir(folder.get()) : nullptr) {
        if (!is_hidden_name_of(entry->d_name, name))
            continue;
        const int place = ::dirfd(folder.get());
        const int part = ::openat(place, entry->d_name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
        if (part < 0)
            continue;
        struct stat status;
        if (::fstat(part, &status) == 0 && S_ISREG(status.st_mode) && ::flock(part, LOCK_EX | LOCK_NB) == 0)
            ::unlinkat(place, entry->d_name, 0);
        ::close(part);
    }
}

} // namespace vmlight
