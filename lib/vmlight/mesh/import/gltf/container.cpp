// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/container.h>

#include <vmlight/base/format.h>
#include <vmlight/base/utf8.h>

#include <algorithm>

namespace vmlight::gltf {
namespace {

constexpr size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
constexpr uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942; // "JSON" and "BIN" as little-endian numbers

uint32_t number_at(const std::string& file, size_t at)
{
    uint32_t number = 0;
    for (size_t i = 4; i-- > 0;)
        number = number << 8 | uint8_t(file[at + i]);
    return number;
}

// Names of sloppy writers are in other encodings; a URI of one is found by no other name anyway.
void replace_invalid_utf8(std::string& text)
{
    uint32_t code = 0;
    for (size_t at = 0; at < text.size();) {
        const size_t length = uint8_t(text[at]) < 0x80 ? 1 : decode_utf8(OIIO::string_view(text).substr(at), code);
        if (length == 0)
            text[at] = '?';
        at += std::max<size_t>(length, 1);
    }
}

void read_chunks(Container& dst, const std::string& file)
{
    if (file.size() < kHeaderBytes + kChunkHeaderBytes)
        throw Error(format("ends early: a GLB has at least 20 bytes, this file {}", file.size()));
    if (const uint32_t version = number_at(file, 4); version != 2)
        throw Error(format("version {} of GLB; supported: 2", version));
    const size_t stated = number_at(file, 8);
    if (stated > file.size())
        throw Error(format("ends early: {} bytes of {}", file.size(), stated));
    bool has_json = false;
    for (size_t at = kHeaderBytes; at + kChunkHeaderBytes <= stated;) {
        const size_t length = number_at(file, at), begin = at + kChunkHeaderBytes;
        const uint32_t type = number_at(file, at + 4);
        if (length > stated - begin)
            throw Error(format("ends early: a chunk of {} bytes starts at byte {} of {}", length, begin, stated));
        if (!has_json && type != kJson)
            throw Error("the first chunk of the GLB is not JSON");
        if (!has_json)
            dst.json = file.substr(begin, length);
        else if (type == kBinary && !dst.binary.data)
            dst.binary = { reinterpret_cast<const uint8_t*>(file.data()) + begin, length };
        has_json = true;
        at = begin + (length + 3) / 4 * 4;
    }
}

} // namespace

Container split_file(const std::string& file)
{
    Container parts;
    if (file.compare(0, 4, "glTF") == 0)
        read_chunks(parts, file);
    else
        parts.json = file.substr(file.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0);
    parts.json.resize(std::min(parts.json.size(), parts.json.find('\0'))); // some pad with zeros
    replace_invalid_utf8(parts.json);
    return parts;
}

} // namespace vmlight::gltf
