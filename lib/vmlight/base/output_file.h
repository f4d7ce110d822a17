// SPDX-License-Identifier: Apache-2.0
/// Atomic output files: written to a temporary file, flushed to disk, then renamed.
#pragma once

#include <vmlight/base/temporary_file.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/string_view.h>

#include <memory>
#include <mutex>
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

/// The same for a writer that takes an IOProxy. No call reports a failure, commit() does: OpenEXR's writer threads
/// deadlock when a write fails. Nothing is buffered, so that each byte fails in the call that writes it.
class OutputFile : public OIIO::Filesystem::IOProxy
{
public:
    /// Opens a temporary file beside the target of `path` (see ok()) and removes those that killed processes left.
    explicit OutputFile(const std::string& path, TemporaryFileKind kind = TemporaryFileKind::Unnamed);
    /// Removes the temporary file unless it was committed.
    ~OutputFile() override;

    const char* proxytype() const override { return "vmlight output"; }
    bool seek(int64_t offset) override;
    size_t read(void* bytes, size_t size) override;
    size_t write(const void* bytes, size_t size) override;
    size_t pread(void* bytes, size_t size, int64_t offset) override;
    size_t pwrite(const void* bytes, size_t size, int64_t offset) override;
    size_t size() const override { return m_size; }

    /// Flush to disk and rename. Returns false if anything failed since the file was opened, or if the file is not as
    /// long as what was written; of a file that was written by its path alone, nobody knows how long it must be.
    bool commit();

    bool ok() const { return m_reason.empty(); }
    const std::string& reason() const { return m_reason; }
    /// The temporary file's path: OpenEXR writes files of several parts by name.
    std::string temporary_path() const { return m_file->path(); }

private:
    void fail(const std::string& reason);

    const std::unique_ptr<TemporaryFile> m_file;
    std::mutex m_mutex; // pread() and pwrite() may come from several threads
    size_t m_size = 0;
    std::string m_reason; // of the first failure
};

} // namespace vmlight
