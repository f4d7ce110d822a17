// SPDX-License-Identifier: Apache-2.0
/// Measured rows, in a file that survives an interrupted run.
#pragma once

#include "row.h"

#include <map>
#include <string>

namespace vmlight::cost {

class Journal
{
public:
    /// Read an existing journal: one JSON object per line, whose last member is a checksum of the rest. Removes lines
    /// that are damaged, incomplete or of another version. Returns false, with the reason in `error`, if the file
    /// exists and cannot be read, or cannot be mended.
    bool open(const std::string& path, std::string& error);

    /// How many lines open() removed.
    int damaged() const { return m_damaged; }

    /// The row with this key, or nullptr.
    const Row* find(const std::string& key) const;

    /// Append a row to the file. Returns false, with the reason in `error`.
    bool add(const std::string& key, const Row& row, std::string& error);

private:
    std::string m_path;
    int m_damaged = 0;
    std::map<std::string, Row> m_rows;
};

/// A key for the inputs that `text` describes: its SHA-1.
std::string hash_key(const std::string& text);

} // namespace vmlight::cost
