// SPDX-License-Identifier: Apache-2.0
#include "fbx_files.h"

#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>

#include <cstdint>

namespace vmlight {
namespace {

// Its lines, with brackets around what it holds, if it `holds` (a Model without anything has brackets too).
std::string fbx_text(const FbxRecord& record, bool holds = false)
{
    std::string text = record.name + ":", inner;
    for (const FbxProperty& property : record.properties) {
        text += &property == record.properties.data() ? " " : ", ";
        if (const auto* number = std::get_if<int32_t>(&property))
            text += std::to_string(*number);
        else if (const auto* id = std::get_if<int64_t>(&property))
            text += std::to_string(*id);
        else if (const auto* word = std::get_if<std::string>(&property))
            text += '"' + *word + '"';
        else if (const auto* numbers = std::get_if<std::vector<double>>(&property))
            text += format("*{} {{ a: {} }}", numbers->size(), OIIO::Strutil::join(*numbers, ","));
        else if (const auto* indices = std::get_if<std::vector<int32_t>>(&property))
            text += format("*{} {{ a: {} }}", indices->size(), OIIO::Strutil::join(*indices, ","));
    }
    for (const FbxRecord& child : record.records)
        inner += fbx_text(child);
    return text + (holds || !inner.empty() ? " {\n" + inner + "}\n" : "\n");
}

std::string fbx_bytes(const FbxProperty& property)
{
    const auto array = [](char type, const auto& numbers) {
        std::string bytes;
        for (const auto number : numbers)
            bytes += little_endian(number);
        return type + little_endian(uint32_t(numbers.size())) + little_endian(uint32_t(0))
            + little_endian(uint32_t(bytes.size())) + bytes;
    };
    if (const auto* number = std::get_if<int32_t>(&property))
        return 'I' + little_endian(*number);
    if (const auto* id = std::get_if<int64_t>(&property))
        return 'L' + little_endian(*id);
    if (const auto* word = std::get_if<std::string>(&property))
        return 'S' + little_endian(uint32_t(word->size())) + *word;
    if (const auto* numbers = std::get_if<std::vector<double>>(&property))
        return array('d', *numbers);
    return array('i', std::get<std::vector<int32_t>>(property));
}

// `start`: where in its file it lies; `word`: 4 bytes, or from version 7500 on 8.
std::string fbx_bytes(const FbxRecord& record, size_t start, size_t word)
{
    std::string properties, inner;
    for (const FbxProperty& property : record.properties)
        properties += fbx_bytes(property);
    const std::string last(3 * word + 1, '\0'); // of a list
    const size_t first = start + last.size() + record.name.size() + properties.size();
    for (const FbxRecord& child : record.records)
        inner += fbx_bytes(child, first + inner.size(), word);
    inner += last;
    return little_endian(uint64_t(first + inner.size()), word) + little_endian(uint64_t(record.properties.size()), word)
        + little_endian(uint64_t(properties.size()), word) + char(record.name.size()) + record.name + properties
        + inner;
}

} // namespace

std::string fbx_of(const std::vector<FbxRecord>& records, int version)
{
    std::string bytes = "; FBX 7.4.0 project file\n";
    if (version != 0)
        bytes = std::string("Kaydara FBX Binary  \0\x1a\0", 23) + little_endian(uint32_t(version));
    const size_t word = version < 7500 ? 4 : 8;
    for (const FbxRecord& record : records)
        bytes += version == 0 ? fbx_text(record, true) : fbx_bytes(record, bytes.size(), word);
    return version == 0 ? bytes : bytes + std::string(3 * word + 1, '\0');
}

} // namespace vmlight
