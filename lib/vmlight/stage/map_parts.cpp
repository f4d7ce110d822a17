// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/map_parts.h>

#include <vmlight/base/format.h>
#include <vmlight/base/part_number.h>
#include <vmlight/base/text_format.h>
#include <vmlight/image/image_file.h>
#include <vmlight/vismap/map_part.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>

namespace vmlight {
namespace {

// Parts of a map that were found so far.
struct FoundParts
{
    int count = 0;
    std::string first_path;
    OIIO::ImageSpec first;
    std::map<int, std::string> paths; // by number
};

using MapName = std::array<std::string, 3>; // material, node and tile

bool add_file(std::map<MapName, FoundParts>& maps, const std::string& path, std::string& error)
{
    PartNumber number;
    TileRange tiles;
    const auto file = OIIO::Filesystem::exists(path) ? open_image(path, error) : nullptr;
    if (!file) {
        error = error.empty() ? format("\"{}\": no such file", path) : error;
        return false;
    }
    const OIIO::ImageSpec& spec = file->spec();
    if (!(error = header_fault(spec)).empty() || !read_part(number, tiles, spec, error)) {
        error = format("\"{}\": {}", path, error);
        return false;
    }
    FoundParts& map = maps[{ spec.get_string_attribute("vmlight:material"), spec.get_string_attribute("vmlight:node"),
                             spec.get_string_attribute("vmlight:udim") }];
    if (map.count == 0) {
        map.count = number.count;
        map.first_path = path;
        map.first = spec;
    }
    if (number.count != map.count)
        error = format("\"{}\" is part {}, but \"{}\" is of {}", path, part_text(number), map.first_path,
                       count_text(map.count, "part", "parts"));
    else if (const std::string fault = part_fault(spec, map.first); !fault.empty())
        error = format("\"{}\" does not fit \"{}\": {}", path, map.first_path, fault);
    else if (const auto [other, is_new] = map.paths.emplace(number.index, path); !is_new)
        error = format("\"{}\" and \"{}\" are both part {}", other->second, path, part_text(number));
    return error.empty();
}

std::string missing_parts(const FoundParts& map)
{
    std::vector<int> missing;
    for (int index = 1; index <= map.count; ++index)
        if (map.paths.count(index) == 0)
            missing.push_back(index);
    return missing.empty()
        ? ""
        : format("\"{}\": {} {} of {} {} missing", map.first_path, plural(int64_t(missing.size()), "part", "parts"),
                 ranges_text(missing), map.count, plural(int64_t(missing.size()), "is", "are"));
}

} // namespace

bool is_whole_part(const std::string& path, const OIIO::ImageSpec& spec)
{
    OIIO::ImageBuf image;
    std::string ignored;
    PartNumber number, expected;
    TileRange tiles, expected_tiles;
    return OIIO::Filesystem::exists(path) && read_image(image, path, ignored)
        && read_part(number, tiles, image.spec(), ignored) && read_part(expected, expected_tiles, spec, ignored)
        && number.index == expected.index && number.count == expected.count && tiles.first == expected_tiles.first
        && tiles.end == expected_tiles.end && part_fault(image.spec(), spec).empty();
}

bool sort_parts(std::vector<PartFiles>& dst, const std::vector<std::string>& paths, std::string& error)
{
    std::map<MapName, FoundParts> maps;
    for (const std::string& path : paths)
        if (!add_file(maps, path, error))
            return false;
    for (const auto& [name, map] : maps) {
        error = missing_parts(map);
        if (!error.empty())
            return false;
        PartFiles& files = dst.emplace_back();
        files.material = name[0];
        files.node = name[1];
        files.udim = OIIO::Strutil::stoi(name[2]);
        for (const auto& [index, path] : map.paths)
            files.paths.push_back(path);
    }
    return true;
}

bool join_files(const MapRows& rows, const std::vector<std::string>& paths, JoinReport& report, std::string& error)
{
    std::string path;
    bool is_named = false; // the path is in the error
    const ReadPart read = [&](OIIO::ImageBuf& part, int index, std::string& reason) {
        path = paths[size_t(index) - 1];
        is_named = !read_image(part, path, reason);
        return !is_named;
    };
    const MapRows given { [&](OIIO::ImageSpec& spec, std::string& reason) {
                             is_named = !rows.begin(spec, reason);
                             return !is_named;
                         },
                          [&](int ybegin, int yend, const float* texels, std::string& reason) {
                              is_named = !rows.take(ybegin, yend, texels, reason);
                              return !is_named;
                          } };
    if (join_parts(given, int(paths.size()), read, report, error))
        return true;
    if (!is_named)
        error = format("\"{}\": {}", path, error);
    return false;
}

} // namespace vmlight
