// SPDX-License-Identifier: Apache-2.0
/// The temporary file that an output is written to before it is renamed.
#pragma once

#include <vmlight/base/interrupt.h>

#include <string>

namespace vmlight {

/// The folder of `path`; "." if it has none.
std::string parent_folder(const std::string& path);

/// Where the bytes are until commit().
enum class TemporaryFileKind
{
    /// In an unnamed file (O_TMPFILE), which disappears with its process, however that ends. Falls back to Hidden where
    /// the file system does not support it or /proc is not mounted.
    Unnamed,
    /// In `.NAME.XXXXXXXX.part` beside the target. A killed process leaves it; see remove_stale_temporaries().
    Hidden
};

/// A file that commit() renames to `target`. It gets the permissions of the file that it replaces, else the default
/// ones, and is locked (flock) while its process writes it.
class TemporaryFile
{
public:
    /// Opens it in the folder of `target`, which must not be a symbolic link.
    TemporaryFile(const std::string& target, TemporaryFileKind kind);
    /// Removes the file unless it was committed.
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    /// Its descriptor, for reading and writing; negative if it could not be opened, see reason().
    int file() const { return m_file; }
    /// A path by which it can be opened again.
    std::string path() const;
    /// Flush to disk, rename to the target, and flush the folder. The old target stays until then. Returns false, with
    /// the system's error in `errno`; if the folder could not be flushed, the target is already the new file.
    bool commit();

    /// Why there is no file, or "".
    const std::string& reason() const { return m_reason; }

private:
    int open_unnamed() const;
    int open_hidden();
    bool give_hidden_name();

    const DeferInterrupts m_defer_interrupts; // until the file is committed or removed
    const std::string m_target, m_name;
    std::string m_hidden_name, m_reason;
    int m_folder = -1, m_file = -1;
};

/// Remove the temporary files of `target` that killed processes left: those with a Hidden name that no process has
/// locked. Leaves files that cannot be opened, and all files where the file system has no locks.
void remove_stale_temporaries(const std::string& target);

} // namespace vmlight
