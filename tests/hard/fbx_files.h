// SPDX-License-Identifier: Apache-2.0
/// FBX files of records, in text and in binary.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <variant>
#include <vector>

namespace vmlight {

using FbxProperty = std::variant<int32_t, int64_t, std::string, std::vector<double>, std::vector<int32_t>>;

struct FbxRecord
{
    std::string name;
    std::vector<FbxProperty> properties;
    std::vector<FbxRecord> records;
};

template <class Number> std::string little_endian(Number number, size_t size = sizeof(Number))
{
    std::string bytes(sizeof(Number), '\0');
    std::memcpy(bytes.data(), &number, sizeof(Number));
    bytes.resize(size);
    return bytes;
}

/// A file of these top-level records.
/// @param version  of the binary form, or 0 for text
std::string fbx_of(const std::vector<FbxRecord>& records, int version);

} // namespace vmlight
