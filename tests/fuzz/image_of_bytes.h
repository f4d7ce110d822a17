// SPDX-License-Identifier: Apache-2.0
/// Bytes as an image.
#pragma once

#include "bytes.h"

#include <vmlight/image/channels.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imagebuf.h>

namespace vmlight::fuzz {

/// The channels that stages know, what is near them, or any names.
inline std::vector<std::string> channels_of(Bytes& bytes)
{
    const std::vector<std::string> color { "R", "G", "B" };
    std::vector<std::string> map(kVismapChannels.begin(), kVismapChannels.end()), names;
    const auto add = [&](const char* prefix, int first, int last) {
        for (int i = first; i < last; ++i)
            map.push_back(prefix + std::to_string(i));
    };
    const uint8_t kind = bytes.byte();
    switch (kind % 16) {
    case 0:
        return color;
    case 1:
        return { "Y" };
    case 2:
        return { "B", "Y", "G", "R", "A" };
    case 3:
        for (size_t count = 1 + bytes.below(6); count > 0; --count)
            names.push_back(bytes.text(8));
        return names;
    case 4:
        return { "direction.x", "direction.y", "direction.z", "visibility" };
    case 5:
        return map;
    default:
        break;
    }
    if (kind & 1)
        map.insert(map.end(), kNormalChannels.begin(), kNormalChannels.end());
    if (kind & 2)
        add("sh.", 4, int(4 + bytes.below(40)));
    if (kind & 4)
        add("mask.", 0, 11);
    if (kind & 8)
        add("cells.", 0, 12);
    return map;
}

inline void add_metadata(OIIO::ImageSpec& spec, Bytes& bytes)
{
    constexpr std::array<const char*, 9> kNames { "vmlight:stage",   "vmlight:lobe",  "vmlight:stack",
                                                  "colorInteropID",  "Software",      "oiio:sampleborder",
                                                  "oiio:ColorSpace", "vmlight:model", "chromaticities" };
    constexpr std::array<const char*, 10> kTexts { "vismap", "cfem",    "lightmap", "true",
                                                   "data",   "unknown", "env",      "oiiotool --colorconvert a b",
                                                   "Linear", "" };
    for (size_t count = bytes.below(4); count > 0; --count) {
        const char* name = bytes.choice(kNames);
        switch (bytes.below(4)) {
        case 0:
            spec.attribute(name, int(bytes.byte()));
            break;
        case 1:
            spec.attribute(name, bytes.number());
            break;
        case 2:
            spec.attribute(name, bytes.text(16));
            break;
        default:
            spec.attribute(name, bytes.choice(kTexts));
        }
    }
}

/// Up to 8x8 pixels, with a display window that may lie elsewhere, of any metadata, in any format that files have.
inline OIIO::ImageBuf image_of(Bytes& bytes, const char* name)
{
    using OIIO::TypeDesc;
    const std::array<TypeDesc, 7> formats { TypeDesc::FLOAT,  TypeDesc::FLOAT,  TypeDesc::HALF, TypeDesc::UINT8,
                                            TypeDesc::UINT16, TypeDesc::DOUBLE, TypeDesc::INT32 };
    const uint8_t windows = bytes.byte();
    const int width = int(1 + bytes.below(8)), height = int(1 + bytes.below(8));
    const std::vector<std::string> channels = channels_of(bytes);
    OIIO::ImageSpec spec(width, height, int(channels.size()), bytes.choice(formats));
    spec.channelnames = channels;
    const auto offset = [&] { return int(bytes.below(16)) - 8; };
    if (windows & 1)
        spec.x = offset(), spec.y = offset();
    if (windows & 2)
        spec.full_x = offset(), spec.full_y = offset();
    if (windows & 4)
        spec.full_width = int(bytes.below(16)), spec.full_height = int(bytes.below(16));
    if ((windows & 96) == 96) // which may overflow
        spec.full_width += int(bytes.byte()) << 24;
    if ((windows & 248) == 248)
        spec.depth = spec.full_depth = 2;
    add_metadata(spec, bytes);
    OIIO::ImageBuf image(name, spec);
    std::vector<float> pixels(size_t(spec.image_pixels()) * channels.size());
    // Whole numbers where the channels say so; all alike where the bytes end.
    const bool packed = holds_whole_numbers(channels.back()) && (windows & 8);
    const float last = windows & 16 ? 0.5f : 0.0f;
    for (float& value : pixels)
        value = bytes.empty() ? last : packed ? float(bytes.byte() * 65536 + bytes.byte()) : bytes.number();
    image.set_pixels(image.roi(), OIIO::TypeFloat, pixels.data());
    return image;
}

} // namespace vmlight::fuzz
