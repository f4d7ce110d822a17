// SPDX-License-Identifier: Apache-2.0
/// One quad with texture coordinates, as the bytes of files of several formats.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

namespace vmlight {

template <class Number> std::string bytes_of(std::initializer_list<Number> numbers)
{
    return std::string(reinterpret_cast<const char*>(numbers.begin()), numbers.size() * sizeof(Number));
}

inline std::string quad_ply_header(const std::string& format)
{
    return "ply\nformat " + format
        + " 1.0\nelement vertex 4\nproperty float x\n"
          "property float y\nproperty float z\nproperty float s\nproperty float t\n"
          "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
}

/// In text, of triangles.
inline std::string quad_ply_text()
{
    return quad_ply_header("ascii") + "-1 -1 0 0 0\n1 -1 0 1 0\n1 1 0 1 1\n-1 1 0 0 1\n3 0 1 2\n3 0 2 3\n";
}

inline std::string quad_ply()
{
    return quad_ply_header("binary_little_endian")
        + bytes_of<float>({ -1, -1, 0, 0, 0, 1, -1, 0, 1, 0, 1, 1, 0, 1, 1, -1, 1, 0, 0, 1 }) + "\3"
        + bytes_of<int32_t>({ 0, 1, 2 }) + "\3" + bytes_of<int32_t>({ 0, 2, 3 });
}

/// The vertices and indices that quad_gltf() points to.
inline std::string quad_buffer()
{
    return bytes_of<float>({ -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 0, 1, 0, 1, 1, 0, 1 })
        + bytes_of<uint16_t>({ 0, 1, 2, 0, 2, 3 });
}

/// @param uri  of the file of quad_buffer(); "" if it follows in a GLB
inline std::string quad_gltf(const std::string& uri = "")
{
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[)"
           R"({"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2}]}],"buffers":[{"byteLength":92)"
        + (uri.empty() ? uri : R"(,"uri":")" + uri + "\"")
        + R"(}],"bufferViews":[)"
          R"({"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":32},)"
          R"({"buffer":0,"byteOffset":80,"byteLength":12}],"accessors":[)"
          R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
          R"({"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},)"
          R"({"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}]})";
}

inline std::string quad_glb()
{
    std::string json = quad_gltf();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::string buffer = quad_buffer();
    const std::string chunks = bytes_of<uint32_t>({ uint32_t(json.size()) }) + "JSON" + json
        + bytes_of<uint32_t>({ uint32_t(buffer.size()) }) + std::string("BIN\0", 4) + buffer;
    return "glTF" + bytes_of<uint32_t>({ 2, uint32_t(12 + chunks.size()) }) + chunks;
}

} // namespace vmlight
