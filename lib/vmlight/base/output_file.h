// SPDX-License-Identifier: Apache-2.0
/// Atomic output files: written to a temporary file, flushed to disk, then renamed.
#pragma once

#include <vmlight/base/temporary_file.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/string_view.h>

#include <memory>
#include <string>

namespace vmlight {

/// "" if `path` can be written now, else the reason why not: its folder must exist and be writable, and `path` must not
/// be a folder, a device, a pipe or a read-only file. Symbolic links are followed.
std::string output_file_fault(const std::string& path);

/// "" if files can be written to the folder `path` now, else the reason why not: it must be a writable folder, or not
/// exist in a writable one.
std::string output_folder_fault(const std::string& path);

/// Write a file atomically. On failure returns false, with the reason in `error`: `path` is then unchanged and no
/// temporary file is left. The new file keeps the permissions of the one it replaces; hard links keep the old content.
bool write_file(const std::string& path, OIIO::string_view bytes, std::string& error);

/// The same for a writer that takes an IOProxy. write() never reports a failure, commit() does: OpenEXR's writer
/// threads deadlock when a write fails.
class OutputFile : public OIIO::Filesystem::IOFile
{
public:
    /// Opens a temporary file beside the target of `path` (see ok()) and removes those that killed processes left.
    explicit OutputFile(const std::string& path, TemporaryFileKind kind = TemporaryFileKind::Unnamed);
    /// Removes the temporary file unless it was committed.
    ~OutputFile() override;

    size_t write(const void* bytes, size_t size) override;
    /// Flush to disk and rename. Returns false if anything failed since the file was opened.
    bool commit();

    bool ok() const { return m_reason.empty(); }
    const std::string& reason() const { return m_reason; }
    /// The temporary file's path: OpenEXR opens it again for each further subimage.
    std::string temporary_path() const { return m_file->path(); }

private:
    explicit OutputFile(std::unique_ptr<TemporaryFile> file);

    std::unique_ptr<TemporaryFile> m_file;
    std::string m_reason;
};

} // namespace vmlight
