// SPDX-License-Identifier: Apache-2.0
/// Numbers of binary files, little-endian, within the file's bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace vmlight {

class BinaryReader
{
public:
    /// @param bytes    must outlive this
    explicit BinaryReader(const std::string& bytes)
        : m_bytes(bytes)
    {
    }

    uint64_t size() const { return m_bytes.size(); }
    /// Whether `count` elements of `element` bytes fit behind byte `offset`.
    bool has(uint64_t offset, uint64_t count, uint64_t element) const
    {
        return offset <= size() && (element == 0 || count <= (size() - offset) / element);
    }
    /// The number at byte `offset`, which has() has checked. Every machine that this runs on is little-endian.
    template <class Number> Number at(uint64_t offset) const
    {
        Number number;
        std::memcpy(&number, m_bytes.data() + offset, sizeof(number));
        return number;
    }

private:
    const std::string& m_bytes;
};

} // namespace vmlight
