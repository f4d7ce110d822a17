// SPDX-License-Identifier: Apache-2.0
/// The container of an Alembic file, for what the Alembic library does not check.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

namespace vmlight::alembic {

/// A file of groups and data. A group is a number of positions, where its elements are: groups, or data with the top
/// bit set. Data are a size and as many bytes. Source: Alembic 1.8, lib/Alembic/Ogawa.
class OgawaFile
{
public:
    /// Throws Error if it cannot be opened.
    explicit OgawaFile(const std::string& path);

    /// The position of the group of the top object.
    uint64_t top_object();
    /// The position of an element of the group at `group`. Throws Error if it has no such element.
    uint64_t element(uint64_t group, uint64_t index);
    /// The text of sample 0 of the string property at `group`. The library writes past the end of its own strings if a
    /// file has several where there should be one.
    std::string text(uint64_t group);

private:
    void read(uint64_t position, void* dst, uint64_t size);
    uint64_t number_at(uint64_t position);

    std::ifstream m_file;
};

} // namespace vmlight::alembic
