// SPDX-License-Identifier: Apache-2.0
/// Files that appear when they are whole: written where no one sees them, flushed to the disk, then given their name.
#pragma once

#include <vmlight/base/part_file.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/string_view.h>

#include <memory>
#include <string>

namespace vmlight {

/// Why nothing can be written to `path` as things are, or "": it must lie in a folder that exists and can be written,
/// and not be a folder, a device, a pipe, or a file that may not be written. Of a link all that is asked of what it
/// leads to.
std::string output_file_fault(const std::string& path);

/// Why no files can be written to the folder `path` as things are, or "": it must be one that can be written, or its
/// parent must be, and nothing else have that name.
std::string output_folder_fault(const std::string& path);

/// Write a file whole or not at all. False, with the reason in `error`: `path` is then as it was, and nothing is left
/// over. The file has the rights of the one that it replaces; another name of that one keeps the old bytes.
bool write_file(const std::string& path, OIIO::string_view bytes, std::string& error);

/// The same for a writer that takes an IOProxy. It keeps its failure to itself: OpenEXR's writing threads, told of a
/// full disk, wait for one another for ever.
class OutputFile : public OIIO::Filesystem::IOFile
{
public:
    /// Opens a file that is to replace what `path` leads to, see sound(); and removes what killed runs left of it.
    explicit OutputFile(const std::string& path, PartKind kind = PartKind::Nameless);
    /// What was not kept is removed.
    ~OutputFile() override;

    size_t write(const void* bytes, size_t size) override;
    /// Flush it to the disk and give it its name. False if anything went wrong since it was opened.
    bool keep();

    bool sound() const { return m_reason.empty(); }
    const std::string& reason() const { return m_reason; }
    /// A name by which it can be opened meanwhile, for a writer of several images, who lets OpenEXR open it again.
    std::string temporary() const { return m_part->path(); }

private:
    explicit OutputFile(std::unique_ptr<PartFile> part);

    std::unique_ptr<PartFile> m_part;
    std::string m_reason;
};

} // namespace vmlight
