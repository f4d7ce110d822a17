// SPDX-License-Identifier: Apache-2.0
/// Triangle meshes, their normals and checks.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/base/params.h>

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vmlight {

/// Triangles in object space (the file's own: right-handed, y up), counter-clockwise seen from outside.
/// Every vertex has a position and a unit normal; vertices that the file gave no texture coordinates have NaN in `uvs`,
/// and if none has any, `uvs` is empty.
struct Mesh
{
    /// File name without its folder.
    std::string name;
    /// The file as it was asked for, or "": for messages.
    std::string path;
    /// Double, because meshes far from the origin lose their shape in float; see read_mesh().
    std::vector<Imath::V3d> positions;
    /// Are the positions as the file has them, and not through float?
    bool has_exact_positions = false;
    std::vector<Imath::V3f> normals;
    /// v up: v = 0 is the bottom of the texture, whatever the file's own rule.
    std::vector<Imath::V2f> uvs;
    std::vector<std::array<uint32_t, 3>> triangles;
    /// One a triangle: the file's material index.
    std::vector<uint32_t> materials;
};

struct MeshParams
{
    /// `file` uses the normals of the file, and makes smooth ones where it has none.
    std::string normals = "file";
    /// Edges sharper than this, in degrees between the face normals, stay sharp under smooth normals.
    double crease_angle = 180;
    int uv_set = 0;
    /// `file` believes the file's axis metadata, where it has any, and else takes y as up.
    std::string up = "file";

    template <class Visit> void visit(Visit&& field)
    {
        field("normals", normals, Choices { { "file", "smooth", "flat" } }, "Vertex normals: the file's own, or made");
        field("crease_angle", crease_angle, Range { 0, 180 },
              "Smooth normals keep edges sharper than this many degrees");
        field("uv_set", uv_set, Range { 0, 7 }, "Which set of texture coordinates");
        field("up", up, Choices { { "file", "y", "z" } }, "The mesh's up axis; z is turned to y");
    }
};

/// Is the mesh one that can be baked or cast? False, with the reason in `error`, if a triangle has a vertex that is not
/// there or not finite (the first is named), or if there are not as many normals, or uvs, if any, as positions.
VMLIGHT_API bool check_mesh(const Mesh& mesh, std::string& error);

/// Give `mesh` one normal a triangle. Splits vertices as needed.
VMLIGHT_API void make_flat_normals(Mesh& mesh);

/// Give `mesh` smooth normals: angle-weighted over all triangles that share a position (equal bit for bit) and meet at
/// no more than `crease_angle` degrees. Splits vertices as needed. A vertex that only triangles without area use gets
/// the zero vector.
/// Source: G. Thuermer, C. Wuethrich, "Computing Vertex Normals from Polygonal Facets", JGT 3(1), 1998.
VMLIGHT_API void make_smooth_normals(Mesh& mesh, double crease_angle);

/// As make_smooth_normals(), for the vertices whose normal is zero only.
VMLIGHT_API void fill_missing_normals(Mesh& mesh, double crease_angle);

/// Merge vertices whose position, normal and uv agree bit for bit; order of first use.
VMLIGHT_API void merge_equal_vertices(Mesh& mesh);

/// 64 bits over positions, normals, uvs and triangles, as 16 hexadecimal digits: equal meshes have equal hashes on
/// every little-endian machine.
VMLIGHT_API std::string mesh_hash(const Mesh& mesh);

/// Normal of a triangle times twice its area; zero if it has none.
inline Imath::V3d triangle_area_normal(const Mesh& mesh, const std::array<uint32_t, 3>& triangle)
{
    const Imath::V3d& a = mesh.positions[triangle[0]];
    return (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a);
}

} // namespace vmlight
