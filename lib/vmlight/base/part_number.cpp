// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/part_number.h>

#include <vmlight/base/format.h>
#include <vmlight/base/frames.h>

#include <algorithm>
#include <set>

namespace vmlight {

bool parse_parts(std::vector<int>& dst, int& count, const std::string& text, std::string& error)
{
    const size_t slash = text.find('/');
    std::vector<int> numbers, counts;
    std::string ignored;
    // No steps: they are for frames.
    if (slash == std::string::npos || text.find('x') != std::string::npos
        || !parse_frames(numbers, text.substr(0, slash), ignored)
        || !parse_frames(counts, text.substr(slash + 1), ignored) || counts.size() != 1) {
        error = format("\"{}\" is not a part; expected something like 3/16 or 1-4,7/16", text);
        return false;
    }
    if (counts[0] < 1 || counts[0] > kMostParts) {
        error = format("\"{}\": a map has 1 to {} parts", text, kMostParts);
        return false;
    }
    const std::set<int> unique(numbers.begin(), numbers.end());
    if (*unique.begin() < 1 || *unique.rbegin() > counts[0]) {
        error = format("\"{}\": parts are numbered from 1 to {}", text, counts[0]);
        return false;
    }
    dst.assign(unique.begin(), unique.end());
    count = counts[0];
    return true;
}

std::string part_text(PartNumber part)
{
    return format("{}/{}", part.index, part.count);
}

std::string part_path(const std::string& path, const std::string& word, PartNumber part)
{
    const size_t folder = path.rfind('/'), dot = path.rfind('.');
    const bool has_extension = dot != std::string::npos && (folder == std::string::npos || dot > folder);
    const size_t at = has_extension ? dot : path.size();
    return path.substr(0, at) + format(".{}{:0{}}of{}", word, part.index, std::to_string(part.count).size(), part.count)
        + path.substr(at);
}

std::string ranges_text(const std::vector<int>& numbers)
{
    std::string text;
    for (size_t first = 0, last = 0; first < numbers.size(); first = last + 1) {
        last = first;
        while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1)
            ++last;
        text += (text.empty() ? "" : ", ")
            + (first == last ? format("{}", numbers[first]) : format("{}-{}", numbers[first], numbers[last]));
    }
    return text;
}

} // namespace vmlight
