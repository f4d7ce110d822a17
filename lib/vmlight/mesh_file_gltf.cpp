// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh_file_gltf.h>

#include <OpenImageIO/strutil.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <vector>

namespace vmlight {
namespace {

using nlohmann::json;
using OIIO::Strutil::fmt::format;

constexpr int kDeepest = 1000; // brackets; a glTF has about ten

// The JSON: all of a .gltf, the first chunk of a GLB.
OIIO::string_view json_of(const std::string& bytes)
{
    constexpr size_t kHeader = 20;
    if (bytes.compare(0, 4, "glTF") != 0 || bytes.size() < kHeader)
        return bytes;
    size_t length = 0;
    for (size_t i = 0; i < 4; ++i)
        length |= size_t(uint8_t(bytes[12 + i])) << (8 * i);
    return OIIO::string_view(bytes).substr(kHeader, std::min(length, bytes.size() - kHeader));
}

bool is_too_deep(OIIO::string_view text)
{
    int depth = 0;
    bool in_string = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string && c == '\\')
            ++i;
        else if (c == '"')
            in_string = !in_string;
        else if (!in_string && (c == '[' || c == '{') && ++depth > kDeepest)
            return true;
        else if (!in_string && (c == ']' || c == '}'))
            --depth;
    }
    return false;
}

} // namespace

std::string gltf_fault(const std::string& bytes)
{
    const OIIO::string_view text = json_of(bytes);
    if (is_too_deep(text))
        return format("its JSON has brackets more than {} deep", kDeepest);
    const auto is_of_use = [](int depth, json::parse_event_t event, json& parsed) {
        return event != json::parse_event_t::key || depth != 1 || parsed == "nodes";
    };
    const json root = json::parse(text.begin(), text.end(), is_of_use, false);
    if (!root.is_object() || !root.contains("nodes") || !root["nodes"].is_array())
        return "";
    const json& nodes = root["nodes"];
    const size_t none = nodes.size();
    std::vector<size_t> parents(nodes.size(), none);
    for (size_t parent = 0; parent < nodes.size(); ++parent) {
        if (!nodes[parent].is_object() || !nodes[parent].contains("children"))
            continue;
        for (const json& child : nodes[parent]["children"]) {
            if (!child.is_number_unsigned() || child.get<uint64_t>() >= none)
                continue;
            size_t& known = parents[child.get<size_t>()];
            if (known != none)
                return format("its node {} is under two others: {} and {}", child.get<size_t>(), known, parent);
            known = parent;
        }
    }
    std::vector<size_t> seen_from(nodes.size(), none);
    for (size_t node = 0; node < nodes.size(); ++node)
        for (size_t up = node; up != none && seen_from[up] == none; up = parents[up]) {
            seen_from[up] = node;
            if (parents[up] != none && seen_from[parents[up]] == node)
                return format("its node {} is under itself", parents[up]);
        }
    return "";
}

} // namespace vmlight
