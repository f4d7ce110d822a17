// SPDX-License-Identifier: Apache-2.0
/// Mesh files with all digits that a double has, for tests that read them back.
#pragma once

#include <vmlight/base/format.h>
#include <vmlight/mesh/mesh.h>

#include <cstring>
#include <string>

namespace vmlight {

/// Positions, uvs and normals; `line_end` between lines.
inline std::string obj_of(const Mesh& mesh, const char* line_end = "\n")
{
    std::string text;
    for (const Imath::V3d& p : mesh.positions)
        text += format("v {:.17g} {:.17g} {:.17g}{}", p.x, p.y, p.z, line_end);
    for (const Imath::V2f& uv : mesh.uvs)
        text += format("vt {:.9g} {:.9g}{}", uv.x, uv.y, line_end);
    for (const Imath::V3f& n : mesh.normals)
        text += format("vn {:.9g} {:.9g} {:.9g}{}", n.x, n.y, n.z, line_end);
    for (const auto& t : mesh.triangles)
        text += format("f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}{3}", t[0] + 1, t[1] + 1, t[2] + 1, line_end);
    return text;
}

/// A PLY of one of the three formats, with positions as `double`.
inline std::string ply_of(const Mesh& mesh, const std::string& format_name)
{
    std::string bytes = format("ply\nformat {} 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
                               "property double z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                               "property float s\nproperty float t\nelement face {}\n"
                               "property list uchar int vertex_indices\nend_header\n",
                               format_name, mesh.positions.size(), mesh.triangles.size());
    const bool is_ascii = format_name == "ascii";
    const auto put = [&](auto number) {
        if (is_ascii) {
            bytes += format("{:.17g} ", double(number));
            return;
        }
        char raw[sizeof(number)];
        std::memcpy(raw, &number, sizeof(number));
        if (format_name == "binary_big_endian")
            std::reverse(raw, raw + sizeof(number));
        bytes.append(raw, sizeof(number));
    };
    const auto end = [&] { bytes += is_ascii ? "\n" : ""; };
    for (size_t v = 0; v < mesh.positions.size(); ++v, end()) {
        for (int axis = 0; axis < 3; ++axis)
            put(mesh.positions[v][axis]);
        for (int axis = 0; axis < 3; ++axis)
            put(mesh.normals[v][axis]);
        put(mesh.uvs[v].x);
        put(mesh.uvs[v].y);
    }
    for (const auto& t : mesh.triangles) {
        put(uint8_t(3));
        for (uint32_t v : t)
            put(int32_t(v));
        end();
    }
    return bytes;
}

} // namespace vmlight
