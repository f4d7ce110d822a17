// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/channels.h>

#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight {

namespace {

// oiiotool and maketx of OIIO 2 record the whole command line.
std::string converting_flag(const OIIO::ImageSpec& spec)
{
    const std::string software = spec.get_string_attribute("Software");
    for (const char* flag :
         { "--colorconvert", "--tocolorspace", "--ociodisplay", "--ociolook", "--ociofiletransform" })
        if (software.find(flag) != std::string::npos)
            return flag;
    return "";
}

// TIFF, which maketx writes to .tx unless asked for another format, has no channel names.
std::string lost_names_hint(const OIIO::ImageSpec& spec)
{
    const bool is_texture = !spec.get_string_attribute("textureformat").empty();
    return is_texture && spec.nchannels >= int(kVismapChannels.size())
        ? "; maketx keeps channel names in OpenEXR alone: make the texture with --format exr"
        : "";
}

} // namespace

std::vector<std::string> numbered_channels(const std::string& basis, int first, int end)
{
    std::vector<std::string> names;
    for (int i = first; i < end; ++i)
        names.push_back(format("{}.{}", basis, i));
    return names;
}

bool find_vismap_channels(const OIIO::ImageSpec& spec, std::array<int, 4>& index, std::string& error)
{
    const std::string stage = spec.get_string_attribute("vmlight:stage");
    if (!stage.empty() && stage != kVismapStage) {
        error = format("not a visibility map: its vmlight:stage is \"{}\", not \"{}\"", stage, kVismapStage);
        return false;
    }
    for (size_t c = 0; c < kVismapChannels.size(); ++c) {
        index[c] = spec.channelindex(kVismapChannels[c]);
        if (index[c] < 0) {
            error = format("not a visibility map: no channel \"{}\" among {}{}", kVismapChannels[c],
                           OIIO::Strutil::join(spec.channelnames, ", "), lost_names_hint(spec));
            return false;
        }
    }
    const std::string space = spec.get_string_attribute("colorInteropID", "data");
    if (space != "data" && space != "unknown") {
        error = format("no longer a visibility map: tagged as colour, \"{}\"", space);
        return false;
    }
    error = orientation_fault(spec);
    if (!error.empty())
        return false;
    const std::string flag = converting_flag(spec);
    if (!flag.empty())
        error = format("no longer a visibility map: its Software attribute shows a colour conversion ({}); bake it "
                       "again, or erase the attribute if it belongs to another image",
                       flag);
    return flag.empty();
}

bool find_color_channels(const OIIO::ImageSpec& spec, std::array<int, 3>& index, std::string& error)
{
    if (spec.get_string_attribute("vmlight:stage") == kVismapStage) {
        error = "a visibility map, not light: its vmlight:stage is \"vismap\"";
        return false;
    }
    index = { spec.channelindex("R"), spec.channelindex("G"), spec.channelindex("B") };
    if (index[0] >= 0 && index[1] >= 0 && index[2] >= 0)
        return true;
    const auto is_light = [](const std::string& name) { return name != "A" && name != "Z"; };
    const int gray = spec.nchannels == 1 && is_light(spec.channelnames[0]) ? 0 : spec.channelindex("Y");
    if (gray >= 0) {
        index = { gray, gray, gray };
        return true;
    }
    error = format("no channels R, G, B among {}", OIIO::Strutil::join(spec.channelnames, ", "));
    return false;
}

std::string orientation_fault(const OIIO::ImageSpec& spec)
{
    const int orientation = spec.get_int_attribute("Orientation", 1);
    return orientation == 1
        ? ""
        : format("pixels are stored flipped or rotated (Orientation {}); fix it with oiiotool --reorient", orientation);
}

bool check_window(const OIIO::ImageSpec& spec, std::string& error)
{
    constexpr int kLongestSide = 1 << 16;
    constexpr double kLarge = 1 << 27, kEmptiest = 256; // pixels; for one that is stored
    const auto [least, most] = std::minmax(spec.full_width, spec.full_height);
    const double shown = double(spec.full_width) * spec.full_height, stored = double(spec.width) * spec.height;
    const int orientation = spec.get_int_attribute("Orientation", 1);
    if (least < 1 || most > kLongestSide)
        error = format("display window of {}x{} pixels: sides must be 1 to {}", spec.full_width, spec.full_height,
                       kLongestSide);
    else if (shown > kLarge && shown > kEmptiest * stored)
        error = format("display window of {}x{} pixels is almost empty: only {}x{} are stored", spec.full_width,
                       spec.full_height, spec.width, spec.height);
    else if (orientation != 1)
        error = orientation_fault(spec);
    else
        return true;
    return false;
}

} // namespace vmlight
