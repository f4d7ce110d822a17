// SPDX-License-Identifier: Apache-2.0
/// Whether a file can hold what its header claims. Libraries believe a header: one wrong bit in a length, a count or a
/// size makes them ask for gigabytes before they reach the end of the file.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

namespace vmlight {

/// What the header of the image file `path` claims that cannot be in a file of its size, or "". Looks at the header
/// alone, of OpenEXR and Radiance files, recognised by content; nothing is said of other files, of names that are not
/// files, and of headers that are invalid in other ways, which OpenImageIO refuses.
std::string claims_fault(const std::string& path);

/// The name of OpenImageIO's reader of the file `path` by its first bytes, of OpenEXR and Radiance files; else "".
/// Asked for a damaged file, OpenImageIO tries all its readers, some of which take 64 MiB to see that it is not theirs.
std::string reader_of(const std::string& path);

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

// The same for one format, from behind its first four bytes.
std::string exr_claims_fault(ClaimReader& file);
std::string radiance_claims_fault(ClaimReader& file);

} // namespace vmlight
