// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/frames.h>

#include <vmlight/base/format.h>
#include <vmlight/base/params.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>

namespace vmlight {

bool parse_frames(std::vector<int>& dst, const std::string& text, std::string& error)
{
    // OIIO ignores what it cannot parse and lists every frame before it returns. So check first: only characters of a
    // range, numbers below a million, no step of 0.
    bool plausible = !text.empty() && text.find_first_not_of("0123456789-,x") == std::string::npos;
    for (size_t begin = 0, end; plausible && begin < text.size(); begin = end + 1) {
        end = std::min(text.find_first_of("-,x", begin), text.size());
        const bool is_step = begin > 0 && text[begin - 1] == 'x';
        plausible = end - begin <= 6 && !(is_step && text.find_first_not_of('0', begin) >= end);
    }
    std::vector<int> frames;
    if (!plausible || !OIIO::Filesystem::enumerate_sequence(text, frames) || frames.empty()) {
        error = format("\"{}\" is not a frame range such as 1-48, 1-48x2 or 1,3,10-12 (frames up to 999999)", text);
        return false;
    }
    dst = frames;
    return true;
}

std::string frame_path(const std::string& pattern, int frame)
{
    const size_t begin = pattern.find('#');
    if (begin == std::string::npos)
        return pattern;
    size_t end = pattern.find_first_not_of('#', begin);
    end = end == std::string::npos ? pattern.size() : end;
    return pattern.substr(0, begin) + format("{:0{}}", frame, end - begin) + pattern.substr(end);
}

bool parse_ramp(Ramp& dst, const std::string& text, std::string& error)
{
    const Range any { -1e9, 1e9 };
    const size_t colon = text.find(':');
    Ramp ramp;
    std::string reason;
    bool good = parse_value(ramp.first, text.substr(0, colon), any, reason);
    ramp.last = ramp.first;
    if (good && colon != std::string::npos)
        good = parse_value(ramp.last, text.substr(colon + 1), any, reason);
    if (!good) {
        error = format("\"{}\" is not FIRST:LAST or one number", text);
        return false;
    }
    dst = ramp;
    return true;
}

} // namespace vmlight
