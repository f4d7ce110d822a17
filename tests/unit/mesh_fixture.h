// SPDX-License-Identifier: Apache-2.0
/// Files of meshes, written and read: for the tests of the mesh rooms.
#pragma once

#include "temporary_folder.h"

#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/mesh/mesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

namespace mesh_files {

using namespace vmlight;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

/// A folder for the files of a test.
class MeshFiles : public testing::Test
{
protected:
    Mesh read(const std::string& path, const MeshParams& params = {})
    {
        Mesh mesh;
        std::string error;
        EXPECT_TRUE(read_mesh(mesh, path, params, error)) << error;
        return mesh;
    }
    Mesh read(const char* name, const std::string& bytes, const MeshParams& params = {})
    {
        return read(folder.write(name, bytes), params);
    }
    /// What is said, less the path at its head.
    std::string refusal(const std::string& path)
    {
        Mesh mesh;
        std::string error;
        EXPECT_FALSE(read_mesh(mesh, path, {}, error));
        const std::string head = "\"" + path + "\": ";
        EXPECT_EQ(error.substr(0, head.size()), head);
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
        return error.substr(std::min(error.size(), head.size()));
    }

    const TemporaryFolder folder;
};

/// A quad 2 wide and 3 high in z = 0, facing +z.
const char* const kQuadObj = "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\n"
                             "vt 0.1 0.2\nvt 0.9 0.2\nvt 0.9 0.8\nvt 0.1 0.8\n"
                             "vn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";

inline double area(const Mesh& mesh)
{
    double sum = 0;
    for (const auto& t : mesh.triangles)
        sum += triangle_area_normal(mesh, t).length() / 2;
    return sum;
}

/// The area times its normal, by the order of the vertices.
inline V3d area_vector(const Mesh& mesh)
{
    V3d sum(0);
    for (const auto& t : mesh.triangles)
        sum += triangle_area_normal(mesh, t) * 0.5;
    return sum;
}

inline std::string base64(const std::string& bytes)
{
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t triple = 0;
        for (size_t k = 0; k < 3; ++k)
            triple = triple << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : digits[triple >> (18 - 6 * k) & 63];
    }
    return text;
}

/// One triangle (0,0,0) (1,0,0) (0,1,0) with normals +z and uvs (0,0) (1,0) (0,0.25), v down as glTF has it, under
/// `nodes`; `roots` are the numbers of those that the scene has.
inline std::string gltf(const std::string& nodes, const std::string& roots = "0")
{
    const float numbers[]
        = { 0, 0, 0, 1, 0, 0, 0, 1, 0, /* normals */ 0, 0, 1, 0, 0, 1, 0, 0, 1, /* uvs */ 0, 0, 1, 0, 0, 0.25f };
    std::string bytes(sizeof(numbers), 0);
    std::memcpy(bytes.data(), numbers, sizeof(numbers));
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes
        + R"(],"meshes":[{"name":"leaf","primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":2,"componentType":5126,"count":3,"type":"VEC2"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36},{"buffer":0,"byteOffset":72,"byteLength":24}],
"buffers":[{"byteLength":96,"uri":"data:application/octet-stream;base64,)"
        + base64(bytes) + "\"}]}";
}

} // namespace mesh_files
