// SPDX-License-Identifier: Apache-2.0
/// glTF files for tests, put together from numbers.
#pragma once

#include "mesh_fixture.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace mesh_files {

using nlohmann::json;

/// glTF's names of component types.
template <class T> inline constexpr int kComponentType = 0;
template <> inline constexpr int kComponentType<int8_t> = 5120;
template <> inline constexpr int kComponentType<uint8_t> = 5121;
template <> inline constexpr int kComponentType<int16_t> = 5122;
template <> inline constexpr int kComponentType<uint16_t> = 5123;
template <> inline constexpr int kComponentType<uint32_t> = 5125;
template <> inline constexpr int kComponentType<float> = 5126;

/// The bytes of numbers, in this machine's order.
template <class T> std::string bytes_of(const std::vector<T>& numbers)
{
    return std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
}

/// A glTF with one buffer. Change `root` at will before asking for the text.
class GltfFile
{
public:
    json root = { { "asset", { { "version", "2.0" } } },
                  { "scene", 0 },
                  { "scenes", { { { "nodes", { 0 } } } } },
                  { "nodes", { { { "mesh", 0 } } } } };
    std::string buffer;

    /// Append bytes to the buffer as a buffer view; its index.
    size_t add_view(const std::string& bytes)
    {
        buffer.resize((buffer.size() + 3) / 4 * 4);
        root["bufferViews"].push_back(
            { { "buffer", 0 }, { "byteOffset", buffer.size() }, { "byteLength", bytes.size() } });
        buffer += bytes;
        return root["bufferViews"].size() - 1;
    }
    /// Append an accessor of a new, packed view; its index.
    template <class T>
    size_t add_accessor(const std::vector<T>& numbers, const std::string& type, bool normalized = false)
    {
        const size_t components = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : size_t(type.back() - '0');
        root["accessors"].push_back({ { "bufferView", add_view(bytes_of(numbers)) },
                                      { "componentType", kComponentType<T> },
                                      { "count", numbers.size() / components },
                                      { "type", type },
                                      { "normalized", normalized } });
        return root["accessors"].size() - 1;
    }
    json& primitive() { return root["meshes"][0]["primitives"][0]; }
    json& accessor(size_t index) { return root["accessors"][index]; }

    /// As a GLB, with the buffer in its binary chunk.
    std::string glb() const
    {
        json whole = root;
        whole["buffers"] = { { { "byteLength", buffer.size() } } };
        const auto padded = [](std::string bytes, char with) {
            bytes.resize((bytes.size() + 3) / 4 * 4, with);
            return bytes;
        };
        const std::string text = padded(whole.dump(), ' '), binary = padded(buffer, '\0');
        return "glTF" + bytes_of<uint32_t>({ 2, uint32_t(28 + text.size() + binary.size()), uint32_t(text.size()) })
            + "JSON" + text + bytes_of<uint32_t>({ uint32_t(binary.size()) }) + std::string("BIN\0", 4) + binary;
    }
    /// As a .gltf, with the buffer as a data URI unless `root` has buffers.
    std::string text() const
    {
        json whole = root;
        if (!whole.contains("buffers"))
            whole["buffers"] = { { { "byteLength", buffer.size() },
                                   { "uri", "data:application/octet-stream;base64," + base64(buffer) } } };
        return whole.dump();
    }
};

/// Of triangle_file().
const std::vector<V3d> kTriangleCorners { V3d(0, 0, 0), V3d(2, 0, 0), V3d(0, 3, 0) };

/// A triangle (0,0,0) (2,0,0) (0,3,0) with normals +z, UVs (0,0) (0.5,0) (0,0.25) of v down, and indices; accessors 0
/// to 3 in this order.
inline GltfFile triangle_file()
{
    GltfFile file;
    file.add_accessor<float>({ 0, 0, 0, 2, 0, 0, 0, 3, 0 }, "VEC3");
    file.add_accessor<float>({ 0, 0, 1, 0, 0, 1, 0, 0, 1 }, "VEC3");
    file.add_accessor<float>({ 0, 0, 0.5f, 0, 0, 0.25f }, "VEC2");
    file.add_accessor<uint16_t>({ 0, 1, 2 }, "SCALAR");
    file.root["meshes"] = {
        { { "name", "leaf" },
          { "primitives",
            { { { "attributes", { { "POSITION", 0 }, { "NORMAL", 1 }, { "TEXCOORD_0", 2 } } }, { "indices", 3 } } } } }
    };
    return file;
}

} // namespace mesh_files
