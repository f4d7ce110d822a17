// SPDX-License-Identifier: Apache-2.0
/// The text of OBJ files: lines, keywords and numbers.
#pragma once

#include <OpenImageIO/string_view.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace vmlight::obj {

/// Call visit(begin, end) for each line, until it returns false. Lines end in LF, CR or both.
template <class Visit> void for_each_line(const std::string& text, Visit&& visit)
{
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
        if (!visit(begin, end))
            return;
        begin = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    }
}

/// Does the line start with the keyword and a blank? The line must end in a zero.
bool has_keyword(const char* line, OIIO::string_view keyword);

/// Parse up to `max_count` numbers, starting at `at`, to the end of the line. False if something else than a comment
/// follows them.
bool parse_numbers(const char* at, size_t max_count, std::vector<double>& numbers);

/// The text without what assimp misreads, one statement per line and lines numbered as before; "" if nothing differs.
std::string sanitized(const std::string& text);

} // namespace vmlight::obj
