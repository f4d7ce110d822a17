// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/channels.h>

#include <vmlight/base/format.h>
#include <vmlight/image/color_labels.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight {

namespace {

// Y is grey if no other channel makes it something else: luminance of chroma (RY, BY), of motion vectors or positions.
bool is_gray(const OIIO::ImageSpec& spec)
{
    return spec.channelindex("Y") >= 0
        && std::all_of(spec.channelnames.begin(), spec.channelnames.end(), [](const std::string& name) {
               return name == "Y" || name == "A" || name == "Z" || name.find('.') != std::string::npos;
           });
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

std::string kernel_of(const OIIO::ImageSpec& spec)
{
    return spec.get_string_attribute("vmlight:kernel", kCosineKernel);
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
    if (is_gray(spec)) {
        index.fill(spec.channelindex("Y"));
        return true;
    }
    const auto has = [&](const char* name) { return spec.channelindex(name) >= 0; };
    error = format("no channels R, G, B, and no Y of grey, among {}; ", OIIO::Strutil::join(spec.channelnames, ", "));
    if (const auto layers = color_layers(spec); !layers.empty())
        error += format("choose a layer with --layer (--albedo-layer): {}", OIIO::Strutil::join(layers, ", "));
    else if (has("X") && has("Y") && has("Z"))
        error
            += "if X, Y, Z are a colour and no position, rename them with oiiotool --ch X,Y,Z --chnames R,G,B and set "
               "--colorspace lin_ciexyzd65_scene";
    else
        error += "if one of them is light, name it with oiiotool --ch NAME,NAME,NAME --chnames R,G,B";
    return false;
}

std::string orientation_fault(const OIIO::ImageSpec& spec)
{
    const int orientation = spec.get_int_attribute("Orientation", 1);
    return orientation == 1
        ? ""
        : format("pixels are stored flipped or rotated (Orientation {}); fix it with oiiotool --reorient", orientation);
}

std::vector<std::string> color_layers(const OIIO::ImageSpec& spec)
{
    std::vector<std::string> layers;
    for (const std::string& name : spec.channelnames) {
        const size_t dot = name.rfind('.');
        const std::string layer = name.substr(0, dot == std::string::npos ? 0 : dot);
        std::array<int, 3> ignored;
        if (!layer.empty() && std::find(layers.begin(), layers.end(), layer) == layers.end()
            && find_layer_channels(spec, layer, ignored))
            layers.push_back(layer);
    }
    return layers;
}

bool find_layer_channels(const OIIO::ImageSpec& spec, const std::string& layer, std::array<int, 3>& index)
{
    const auto channel = [&](const char* name) { return spec.channelindex(layer + "." + name); };
    index = { channel("R"), channel("G"), channel("B") };
    if (std::count(index.begin(), index.end(), -1) == 3 && channel("X") < 0)
        index.fill(channel("Y"));
    return std::count(index.begin(), index.end(), -1) == 0;
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
