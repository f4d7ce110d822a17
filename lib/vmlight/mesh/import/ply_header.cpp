// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/ply_header.h>

#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <iterator>

namespace vmlight::ply {
namespace {

using Words = std::vector<std::string>;

constexpr Type kTypes[]
    = { { "char", "int8", 1, 's' },     { "uchar", "uint8", 1, 'u' },   { "short", "int16", 2, 's' },
        { "ushort", "uint16", 2, 'u' }, { "int", "int32", 4, 's' },     { "uint", "uint32", 4, 'u' },
        { "float", "float32", 4, 'f' }, { "double", "float64", 8, 'f' } };

const char* const kFormats[] = { "ascii", "binary_little_endian", "binary_big_endian" };

const Type* find_type(const std::string& name)
{
    const auto type = std::find_if(std::begin(kTypes), std::end(kTypes),
                                   [&](const Type& t) { return name == t.name || name == t.other_name; });
    return type == std::end(kTypes) ? nullptr : type;
}

std::string add_element(Header& header, const Words& words, size_t file_size)
{
    char* rest = nullptr;
    const double count = OIIO::Strutil::strtod(words[2].c_str(), &rest);
    if (*rest != '\0' || !(count >= 0 && count <= double(file_size)))
        return format("invalid PLY header: {} of element \"{}\" in a file of {} bytes", words[2], words[1], file_size);
    header.elements.push_back({ words[1], size_t(count), {} });
    return "";
}

std::string add_property(Header& header, const Words& words)
{
    const bool is_list = words.size() == 5 && words[1] == "list";
    Property property { words.back(), words.size() > 2 ? find_type(words[is_list ? 3 : 1]) : nullptr };
    property.count = is_list ? find_type(words[2]) : nullptr;
    if (header.elements.empty() || !property.type || (is_list && !property.count) || (!is_list && words.size() != 3))
        return format("invalid PLY property: \"{}\"", OIIO::Strutil::join(words, " "));
    header.elements.back().properties.push_back(property);
    return "";
}

// Why the line is invalid, or "".
std::string add_line(Header& header, const std::string& line, const Words& words, size_t file_size)
{
    if (words.size() > 2 && words[0] == "comment" && words[1] == "TextureFile")
        header.textures.push_back(OIIO::Strutil::strip(line.substr(line.find(words[1]) + words[1].size())));
    if (words.size() > 1 && words[0] == "format")
        header.format = words[1];
    if (words.size() > 2 && words[0] == "element")
        return add_element(header, words, file_size);
    return !words.empty() && words[0] == "property" ? add_property(header, words) : "";
}

} // namespace

Header read_header(const std::string& bytes)
{
    Header header;
    for (size_t begin = 0; begin < bytes.size();) {
        const size_t end = std::min(bytes.find('\n', begin), bytes.size());
        const std::string line = bytes.substr(begin, end - begin);
        const Words words = OIIO::Strutil::splits(line);
        header.body = std::min(end + 1, bytes.size());
        const bool is_end = !words.empty() && words[0] == "end_header";
        if (!is_end)
            header.error = add_line(header, line, words, bytes.size());
        if (is_end && std::find(std::begin(kFormats), std::end(kFormats), header.format) == std::end(kFormats))
            header.error = format("invalid PLY header: format \"{}\"", header.format);
        if (is_end || !header.error.empty())
            return header;
        begin = end + 1;
    }
    header.error = "PLY header has no end_header line";
    return header;
}

} // namespace vmlight::ply
