// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/uri.h>
#include <vmlight/mesh/tinygltf.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <limits>
#include <vector>

namespace vmlight::gltf {
namespace {

int hex_value(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    const char lower = char(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

} // namespace

std::string decode_percent(const std::string& text)
{
    std::string decoded;
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size() && hex_value(text[i + 1]) >= 0 && hex_value(text[i + 2]) >= 0) {
            decoded += char(hex_value(text[i + 1]) * 16 + hex_value(text[i + 2]));
            i += 2;
        } else {
            decoded += text[i];
        }
    }
    return decoded;
}

std::string uri_scheme(const std::string& uri)
{
    size_t end = 0;
    while (end < uri.size()
           && (std::isalnum(uint8_t(uri[end])) || uri[end] == '+' || uri[end] == '-' || uri[end] == '.'))
        ++end;
    return end > 1 && end < uri.size() && uri[end] == ':' && std::isalpha(uint8_t(uri[0])) ? uri.substr(0, end) : "";
}

bool decode_data_uri(std::string& bytes, const std::string& uri)
{
    const size_t comma = std::min(uri.find(','), uri.size() - 1);
    if (!OIIO::Strutil::iends_with(uri.substr(0, comma), ";base64")) {
        bytes = decode_percent(uri.substr(comma + 1));
        return true;
    }
    std::string type; // tinygltf decodes the media types that it knows, whatever is in them, and counts in int
    if (uri.size() > size_t(std::numeric_limits<int>::max()))
        return false;
    std::vector<uint8_t> decoded;
    const bool good = tinygltf::DecodeDataURI(
        &decoded, type, "data:application/octet-stream;base64," + uri.substr(comma + 1), 0, false);
    bytes.assign(decoded.begin(), decoded.end());
    return good;
}

} // namespace vmlight::gltf
