// SPDX-License-Identifier: Apache-2.0
/// Whether a file can hold what its header claims. Libraries believe a header: one wrong bit in a length, a count or a
/// size makes them ask for gigabytes before they reach the end of the file.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

namespace vmlight {

/// What an image file is, by its first bytes: OpenEXR or Radiance.
struct FileHeader
{
    /// The name of OpenImageIO's reader, or "" for other files. Asked for a damaged file, OpenImageIO tries all its
    /// readers, some of which take 64 MiB to see that it is not theirs.
    std::string reader;
    /// What its header claims that cannot be in a file of its size, or why OpenImageIO would misread its pixels, or "".
    /// Nothing is said of headers that are invalid in other ways, which OpenImageIO refuses.
    std::string fault;
};

/// Looks at the header of the file `path` alone. Empty for other files, and for names that are not files.
FileHeader inspect_header(const std::string& path);

/// inspect_header().fault
std::string claims_fault(const std::string& path);

/// Reads a file's first bytes in order, and knows how many are left.
class ClaimReader
{
public:
    explicit ClaimReader(const std::string& path);
    ~ClaimReader();
    ClaimReader(const ClaimReader&) = delete;
    ClaimReader& operator=(const ClaimReader&) = delete;

    int64_t left() const { return m_size - m_at; }
    /// False if fewer bytes are left.
    bool read(void* bytes, int64_t count);
    bool skip(int64_t count);
    /// Read up to and without `end`; false if there is none in the next `most` bytes.
    bool read_until(char end, std::string& text, size_t most);

private:
    std::FILE* m_file = nullptr;
    int64_t m_size = 0, m_at = 0;
};

/// Bytes of decoded pixels that may be missing: a file that was cut short is opened, and fails where it is read.
constexpr double kSmallImage = 1 << 20;

/// FileHeader::fault of an OpenEXR file, from behind its first four bytes.
std::string exr_claims_fault(ClaimReader& file);

} // namespace vmlight
