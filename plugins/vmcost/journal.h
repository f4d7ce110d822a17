// SPDX-License-Identifier: Apache-2.0
/// Rows that were measured, in a file that outlives a run that is cut short.
#pragma once

#include "row.h"

#include <map>
#include <string>

namespace vmlight::cost {

class Journal
{
public:
    /// Read what is there: a file of one JSON object a line. A last line that a killed run left torn, and lines of
    /// another version, are passed over. False, with the reason in `error`, if the file is there and cannot be read.
    bool open(const std::string& path, std::string& error);

    /// The row of that key, or nullptr.
    const Row* find(const std::string& key) const;

    /// Add a row, on the disk before this returns. False, with the reason in `error`.
    bool add(const std::string& key, const Row& row, std::string& error);

private:
    std::string m_path;
    bool m_torn = false;
    std::map<std::string, Row> m_rows;
};

/// The key of inputs that `text` tells all of: equal texts, equal keys.
std::string key_of(const std::string& text);

} // namespace vmlight::cost
