// SPDX-License-Identifier: Apache-2.0
/// What a file is written to before it takes its place.
#pragma once

#include <vmlight/base/interrupt.h>

#include <cstdio>
#include <string>

namespace vmlight {

/// The folder that holds `path`; "." if it names none.
std::string folder_of(const std::string& path);

/// Where the bytes are meanwhile.
enum class PartKind
{
    /// In a file without a name, which goes with its process, however that ends. Where the file system has none, or
    /// there is no /proc to name it by: Hidden.
    Nameless,
    /// In `.NAME.XXXXXXXX.part` beside the target. A killed process leaves it; see remove_abandoned_parts().
    Hidden
};

/// A file that will replace `target`, or be the first of that name. It has the rights of the file that it replaces, and
/// else those that any new file has. One process at a time holds its lock.
class PartFile
{
public:
    /// Opens it in the folder of `target`, which is no link.
    PartFile(const std::string& target, PartKind kind);
    /// What was not placed is removed.
    ~PartFile();
    PartFile(const PartFile&) = delete;
    PartFile& operator=(const PartFile&) = delete;

    /// nullptr if it could not be opened.
    std::FILE* stream() const { return m_stream; }
    /// A name by which it can be opened, for a writer that takes no stream.
    std::string path() const;
    /// Flush it to the disk, give it the name of the target, and flush the folder. What lay there stays until then.
    /// False, with the system's error in `errno`.
    bool place();

    /// "", or why there is no stream.
    const std::string& reason() const { return m_reason; }

private:
    int open_nameless() const;
    int open_hidden();
    bool give_hidden_name();

    const WhileWriting m_there; // an interrupt waits for it to be placed or gone
    const std::string m_target, m_name;
    std::string m_hidden, m_reason;
    int m_folder = -1;
    std::FILE* m_stream = nullptr;
};

/// Remove what killed processes left of `target`: files named as Hidden ones are whose lock no process holds. Of files
/// that may not be opened, or whose file system has no locks, none.
void remove_abandoned_parts(const std::string& target);

} // namespace vmlight
