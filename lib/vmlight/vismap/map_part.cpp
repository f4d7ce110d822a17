// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/map_part.h>

#include <vmlight/base/format.h>
#include <vmlight/base/tile_size.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <vector>

namespace vmlight {
namespace {

// More than any image has.
constexpr int kMostTiles = 1 << 30;
constexpr const char* kMetadataPrefix = "vmlight:";
constexpr const char* kPartNumber = "vmlight:part";
constexpr const char* kPartTiles = "vmlight:partTiles";
constexpr const char* kPartChannels = "vmlight:partChannels";
constexpr const char* kPartInputs = "vmlight:partInputs";
constexpr const char* kPartEmpty = "vmlight:partEmpty";

bool is_of_part(const std::string& name)
{
    const char* const names[] = { kPartNumber, kPartTiles, kPartChannels, kPartInputs, kPartEmpty };
    return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

// By name, those that two parts of a map have in common.
std::map<std::string, std::string> shared_metadata(const OIIO::ImageSpec& spec)
{
    std::map<std::string, std::string> found;
    for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
        const std::string name = attribute.name().string();
        if (OIIO::Strutil::starts_with(name, kMetadataPrefix) && name != kPartNumber && name != kPartTiles)
            found[name] = attribute.get_string();
    }
    return found;
}

// For messages: the parameter's name.
std::string title_of(const std::string& name)
{
    return name == kPartInputs ? "hash of the textures" : name.substr(std::string(kMetadataPrefix).size());
}

int tiles_across(const OIIO::ImageSpec& spec)
{
    return (spec.full_width + kTileSize - 1) / kTileSize;
}

// The metadata of the map whose texts are empty: readers of EXR files leave those out.
std::string empty_metadata(const OIIO::ImageSpec& map)
{
    std::vector<std::string> names;
    for (const OIIO::ParamValue& attribute : map.extra_attribs)
        if (const std::string name = attribute.name().string(); OIIO::Strutil::starts_with(name, kMetadataPrefix)
            && attribute.type() == OIIO::TypeDesc::STRING && attribute.get_string().empty())
            names.push_back(name);
    return OIIO::Strutil::join(names, ",");
}

// Of whole tiles: what of the map a part stores. An image has at least one pixel, so that of no tiles is the first.
OIIO::ROI window_of(const OIIO::ImageSpec& spec, TileRange tiles)
{
    OIIO::ROI window = tile_window(spec, tiles.count() > 0 ? tiles.first : 0);
    for (int tile = tiles.first; tile < tiles.end; ++tile)
        window = OIIO::roi_union(window, tile_window(spec, tile));
    return window;
}

bool holds(const OIIO::ImageSpec& spec, const OIIO::ROI& window)
{
    return spec.x <= window.xbegin && spec.y <= window.ybegin && spec.x + spec.width >= window.xend
        && spec.y + spec.height >= window.yend;
}

bool read_tiles(TileRange& dst, const std::string& text)
{
    OIIO::string_view rest = text;
    int first = 0, last = 0;
    if (text.empty()) {
        dst = {};
        return true;
    }
    if (!OIIO::Strutil::parse_int(rest, first) || !OIIO::Strutil::parse_char(rest, '-')
        || !OIIO::Strutil::parse_int(rest, last) || !rest.empty() || first < 0 || last < first || last > kMostTiles)
        return false;
    dst = { first, last + 1 };
    return true;
}

} // namespace

int tile_count(const OIIO::ImageSpec& spec)
{
    return tiles_across(spec) * ((spec.full_height + kTileSize - 1) / kTileSize);
}

OIIO::ROI tile_window(const OIIO::ImageSpec& spec, int tile)
{
    const int x = tile % tiles_across(spec) * kTileSize, y = tile / tiles_across(spec) * kTileSize;
    return { x, std::min(x + kTileSize, spec.full_width), y, std::min(y + kTileSize, spec.full_height) };
}

OIIO::ImageSpec describe_part(const OIIO::ImageSpec& whole, PartNumber part, TileRange tiles, const std::string& inputs)
{
    OIIO::ImageSpec spec = whole;
    spec.attribute(kPartChannels, OIIO::Strutil::join(whole.channelnames, ","));
    spec.attribute(kPartEmpty, empty_metadata(whole));
    auto& names = spec.channelnames;
    if (std::find(names.begin(), names.end(), kCoverageChannel) == names.end())
        names.emplace_back(kCoverageChannel);
    spec.nchannels = int(names.size());
    const OIIO::ROI window = window_of(whole, tiles);
    spec.x = window.xbegin;
    spec.y = window.ybegin;
    spec.width = window.width();
    spec.height = window.height();
    spec.attribute("vmlight:stage", kPartStage);
    spec.attribute(kPartNumber, part_text(part));
    spec.attribute(kPartTiles, tiles.count() > 0 ? format("{}-{}", tiles.first, tiles.end - 1) : "");
    spec.attribute(kPartInputs, inputs);
    return spec;
}

bool read_part(PartNumber& part, TileRange& tiles, const OIIO::ImageSpec& spec, std::string& error)
{
    if (const std::string stage = spec.get_string_attribute("vmlight:stage"); stage != kPartStage) {
        error = stage.empty() ? "not a part of a visibility map: it has no vmlight:stage"
                              : format("not a part of a visibility map: its vmlight:stage is \"{}\"", stage);
        return false;
    }
    std::vector<int> indices;
    std::string ignored;
    const std::vector<std::string> names = OIIO::Strutil::splits(spec.get_string_attribute(kPartChannels), ",");
    const auto has_channel = [&](const std::string& name) {
        return std::count(spec.channelnames.begin(), spec.channelnames.end(), name) == 1;
    };
    if (parse_parts(indices, part.count, spec.get_string_attribute(kPartNumber), ignored) && indices.size() == 1
        && read_tiles(tiles, spec.get_string_attribute(kPartTiles)) && spec.full_x == 0 && spec.full_y == 0
        && spec.full_width > 0 && spec.full_height > 0 && tiles.end <= tile_count(spec)
        && holds(spec, window_of(spec, tiles)) && names.size() >= kVismapChannels.size()
        && std::equal(kVismapChannels.begin(), kVismapChannels.end(), names.begin())
        && std::all_of(names.begin(), names.end(), has_channel) && has_channel(kCoverageChannel)) {
        part.index = indices[0];
        return true;
    }
    error = "a damaged part of a visibility map: its metadata, size and channels do not fit together";
    return false;
}

std::string part_fault(const OIIO::ImageSpec& spec, const OIIO::ImageSpec& expected)
{
    const auto ours = shared_metadata(spec), theirs = shared_metadata(expected);
    const auto value = [](const auto& metadata, const std::string& name) {
        const auto found = metadata.find(name);
        return found == metadata.end() || found->second.empty() ? "none" : found->second;
    };
    auto names = ours;
    names.insert(theirs.begin(), theirs.end());
    for (const auto& [name, ignored] : names)
        if (value(ours, name) != value(theirs, name))
            return format("{} is {}, not {}", title_of(name), value(ours, name), value(theirs, name));
    if (spec.full_width != expected.full_width || spec.full_height != expected.full_height)
        return format("it is of {}x{} texels, not {}x{}", spec.full_width, spec.full_height, expected.full_width,
                      expected.full_height);
    return "";
}

OIIO::ImageSpec whole_of_part(const OIIO::ImageSpec& part)
{
    const std::vector<std::string> names = OIIO::Strutil::splits(part.get_string_attribute(kPartChannels), ",");
    OIIO::ImageSpec spec(part.full_width, part.full_height, int(names.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames = names;
    spec.tile_width = spec.tile_height = kTileSize;
    spec.tile_depth = 1;
    tag_data(spec);
    for (const OIIO::ParamValue& attribute : part.extra_attribs)
        if (const std::string name = attribute.name().string();
            OIIO::Strutil::starts_with(name, kMetadataPrefix) && !is_of_part(name))
            spec.extra_attribs.push_back(attribute);
    for (const std::string& name : OIIO::Strutil::splits(part.get_string_attribute(kPartEmpty), ","))
        if (OIIO::Strutil::starts_with(name, kMetadataPrefix))
            spec.attribute(name, "");
    spec.attribute("vmlight:stage", kVismapStage);
    return spec;
}

} // namespace vmlight
