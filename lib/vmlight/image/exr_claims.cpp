// SPDX-License-Identifier: Apache-2.0
// Sizes in OpenEXR headers: https://openexr.com/en/latest/OpenEXRFileLayout.html
#include <vmlight/image/file_claims.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace vmlight {
namespace {

// Sums of sizes are doubles: no claim overflows them.

constexpr uint32_t kTiled = 0x200, kDeep = 0x800, kParts = 0x1000; // bits of the version
constexpr size_t kLongestName = 255;
constexpr int64_t kLongestList = 1 << 24; // bytes of channels that are looked at

/// One row per number that stands for a compression in a file.
struct Compression
{
    int rows; // of a chunk
    /// No codec makes more of a byte. 0: unknown, or without limit.
    double most_bytes;
};
constexpr double kDeflate = 1032;
constexpr Compression kCompressions[] = {
    { 1, 1 }, // none
    { 1, 64 }, // RLE: 128 equal bytes in 2
    { 1, kDeflate }, // ZIPS
    { 16, kDeflate }, // ZIP
    { 32, 512 }, // PIZ: at best 256 half floats in 10 bits
    { 16, 2 * kDeflate }, // PXR24 drops a byte of each float
    { 32, 16 }, // B44
    { 32, 16 }, // B44A: at best 16 half floats in 3 bytes
    { 32, 64 * kDeflate }, // DWAA: 64 floats of a block are 2 + 2 bytes, deflated
    { 256, 64 * kDeflate }, // DWAB
};

uint32_t number_at(const char* bytes)
{
    const auto* b = reinterpret_cast<const unsigned char*>(bytes);
    return uint32_t(b[0]) | uint32_t(b[1]) << 8 | uint32_t(b[2]) << 16 | uint32_t(b[3]) << 24;
}

/// What sizes follow from; as OpenEXR takes it where an attribute is missing or invalid, so that it refuses the file.
struct Part
{
    double width = 0, height = 0;
    double tile_width = 0, tile_height = 0;
    int level_mode = 0; // one, mip, rip
    bool rounds_up = false, is_tiled = false, is_deep = false, is_known = true;
    const Compression* compression = nullptr;
    double pixel_bytes = 0;
};

// Name, type and value of an attribute whose size is plausible.
struct Attribute
{
    std::string name, type, value;
};

// Channels: name, 0, then a number for the type, 4 bytes of flags, and the sampling rates.
double bytes_of_pixel(const std::string& list)
{
    double bytes = 0;
    for (size_t at = 0; at < list.size() && list[at];) {
        at = list.find('\0', at);
        if (at == std::string::npos || list.size() - at < 17)
            break;
        const double rates = double(number_at(&list[at + 9])) * double(number_at(&list[at + 13]));
        bytes += (number_at(&list[at + 1]) == 1 ? 2 : 4) / std::max(1.0, rates);
        at += 17;
    }
    return bytes;
}

void take(Part& part, const Attribute& attribute)
{
    const std::string& value = attribute.value;
    const auto is = [&](const char* name, size_t size) { return attribute.name == name && value.size() == size; };
    const auto side = [&](int from) { // of a box of integers
        return double(int32_t(number_at(&value[from + 8]))) - double(int32_t(number_at(&value[from]))) + 1;
    };
    if (is("dataWindow", 16)) {
        part.width = std::max(0.0, side(0));
        part.height = std::max(0.0, side(4));
    } else if (is("tiles", 9)) {
        part.tile_width = number_at(&value[0]);
        part.tile_height = number_at(&value[4]);
        part.level_mode = value[8] & 15;
        part.rounds_up = value[8] & 16;
    } else if (is("compression", 1)) {
        const auto index = static_cast<unsigned char>(value[0]);
        part.compression = index < std::size(kCompressions) ? &kCompressions[index] : nullptr;
    } else if (attribute.name == "channels") {
        part.pixel_bytes = bytes_of_pixel(value);
    } else if (attribute.name == "type") {
        part.is_tiled = value == "tiledimage" || value == "deeptile";
        part.is_deep = value == "deepscanline" || value == "deeptile";
        part.is_known = part.is_tiled || part.is_deep || value == "scanlineimage";
    }
}

// Why the sizes inside a value exceed it, or "".
std::string value_fault(const Attribute& attribute)
{
    const std::string& value = attribute.value;
    if (attribute.type == "preview" && value.size() >= 8
        && 4.0 * number_at(&value[0]) * number_at(&value[4]) > double(value.size() - 8))
        return format("its header says that the preview has {}x{} pixels, in {} bytes", number_at(&value[0]),
                      number_at(&value[4]), value.size());
    if (attribute.type == "stringvector")
        for (size_t at = 0; value.size() - at >= 4;) {
            const size_t length = number_at(&value[at]);
            if (length > value.size() - at - 4)
                return format("its header says that a string in \"{}\" has {} bytes, of {}",
                              shortened_line(attribute.name), length, value.size() - at - 4);
            at += 4 + length;
        }
    return "";
}

// Reads the attributes of a part up to the end of its header. False at the end of the list of parts, at the end of the
// file, or with the reason in `fault`.
bool read_part(ClaimReader& file, Part& part, std::string& fault)
{
    Attribute attribute;
    for (bool is_first = true;; is_first = false) {
        if (!file.read_until('\0', attribute.name, kLongestName))
            return false;
        if (attribute.name.empty())
            return !is_first;
        char raw[4];
        if (!file.read_until('\0', attribute.type, kLongestName) || !file.read(raw, 4))
            return false;
        const int64_t size = number_at(raw);
        if (size > file.left()) {
            fault = format("its header says that \"{}\" has {} bytes; the file has {} more",
                           shortened_line(attribute.name), size, file.left());
            return false;
        }
        attribute.value.resize(size <= kLongestList ? size_t(size) : 0);
        if (!file.read(attribute.value.data(), int64_t(attribute.value.size()))
            || !file.skip(size - int64_t(attribute.value.size())))
            return false;
        fault = value_fault(attribute);
        if (!fault.empty())
            return false;
        take(part, attribute);
    }
}

double tiles_of(const Part& part)
{
    const auto level_side = [&](double side, int level) {
        const double exact = std::ldexp(side, -level);
        return std::max(1.0, part.rounds_up ? std::ceil(exact) : std::floor(exact));
    };
    const auto levels = [&](double side) {
        const double exact = std::log2(std::max(1.0, side));
        return part.level_mode == 0 ? 1 : int(part.rounds_up ? std::ceil(exact) : std::floor(exact)) + 1;
    };
    const auto across = [&](int level) { return std::ceil(level_side(part.width, level) / part.tile_width); };
    const auto down = [&](int level) { return std::ceil(level_side(part.height, level) / part.tile_height); };
    double tiles = 0;
    if (part.level_mode == 2)
        for (int y = 0; y < levels(part.height); ++y)
            for (int x = 0; x < levels(part.width); ++x)
                tiles += across(x) * down(y);
    else
        for (int level = 0; level < levels(std::max(part.width, part.height)); ++level)
            tiles += across(level) * down(level);
    return tiles;
}

/// Sizes behind the headers.
struct Sizes
{
    /// Of the tables of chunks, which are read when the file is opened.
    double tables = 0;
    /// Of tables and chunks, whose pixels are as well compressed as can be, and of the pixels decoded.
    double least = 0, decoded = 0;
};

void add(Sizes& sizes, const Part& part, bool has_parts)
{
    const bool is_valid = part.is_known && part.compression && part.width > 0 && part.height > 0
        && (!part.is_tiled || (part.tile_width > 0 && part.tile_height > 0 && part.level_mode <= 2));
    if (!is_valid)
        return;
    const double chunks = part.is_tiled ? tiles_of(part) : std::ceil(part.height / part.compression->rows);
    const double head = (has_parts ? 4 : 0) + (part.is_deep ? 24 + (part.is_tiled ? 16 : 4) : part.is_tiled ? 20 : 8);
    const double decoded = part.is_deep ? 0 : part.width * part.height * part.pixel_bytes;
    sizes.tables += chunks * 8;
    sizes.decoded += decoded;
    sizes.least += chunks * (8 + head) + decoded / part.compression->most_bytes;
}

// Tiles may be larger than their picture, but a decoder makes room for whole ones.
std::string tile_fault(const Part& part)
{
    constexpr double kLargestTile = 8192;
    const auto is_too_large = [&](double tile, double side) { return tile > std::max(kLargestTile, side); };
    return part.is_tiled && (is_too_large(part.tile_width, part.width) || is_too_large(part.tile_height, part.height))
        ? format("its header says tiles of {:.0f}x{:.0f} in a picture of {:.0f}x{:.0f} pixels", part.tile_width,
                 part.tile_height, part.width, part.height)
        : "";
}

} // namespace

std::string exr_claims_fault(ClaimReader& file)
{
    char raw[4];
    if (!file.read(raw, 4))
        return "";
    const uint32_t version = number_at(raw);
    const bool has_parts = version & kParts;
    std::vector<Part> parts;
    std::string fault;
    do {
        Part part;
        part.is_tiled = version & kTiled;
        part.is_deep = version & kDeep;
        if (!read_part(file, part, fault))
            break;
        parts.push_back(part);
    } while (has_parts);
    Sizes sizes;
    for (const Part& part : parts) {
        add(sizes, part, has_parts);
        if (fault.empty())
            fault = tile_fault(part);
    }
    const auto left = double(file.left());
    if (fault.empty() && (sizes.tables > left || (sizes.least > left && sizes.decoded > kSmallImage)))
        fault = format("its header says {:.0f}x{:.0f} pixels{}, which take {:.0f} bytes or more; the file has {}",
                       parts[0].width, parts[0].height, has_parts ? format(" in {} parts", parts.size()) : "",
                       sizes.least, file.left());
    return fault;
}

} // namespace vmlight
