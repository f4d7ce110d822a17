// SPDX-License-Identifier: Apache-2.0
/// The numbers behind the header of a PLY file, in all three encodings.
#pragma once

#include <vmlight/mesh/import/ply_header.h>
#include <vmlight/mesh/import/text_number.h>

#include <cstddef>
#include <string>

namespace vmlight::ply {

enum class Reading
{
    good,
    end, ///< past the end of the file, or of the element's line
    no_number
};

/// Reads the numbers of the body in order. In an ascii file, each element is a line; blank lines are skipped.
class Body
{
public:
    Body(const std::string& bytes, const Header& header);

    /// False at the end of an ascii file; in a binary one, reading finds the end.
    bool next_element();
    Reading read(const Type& type, TextNumber& number);

    // Of a binary file: the next byte, how many are left, and the number that begins `offset` bytes on, unchecked.
    bool is_binary() const { return !m_ascii; }
    const char* here() const { return m_bytes.data() + m_at; }
    size_t left() const { return m_bytes.size() - m_at; }
    TextNumber number_at(const Type& type, size_t offset) const;
    void skip(size_t bytes) { m_at += bytes; }

private:
    bool find_word();

    const std::string& m_bytes;
    size_t m_at, m_line_end;
    bool m_ascii, m_swapped;
};

} // namespace vmlight::ply
