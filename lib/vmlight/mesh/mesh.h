// SPDX-License-Identifier: Apache-2.0
/// Triangle meshes, their normals and checks.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/base/params.h>
#include <vmlight/mesh/material.h>
#include <vmlight/mesh/triangle_indices.h>

#include <Imath/ImathVec.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// A node of a mesh file's hierarchy, or an object or group of a file without one.
struct MeshNode
{
    std::string name;
    int parent = -1; ///< index of a node before this one; -1 at the top
    bool is_instance = false; ///< a place where the file puts a mesh, which has UVs of its own: see baked_instances()
};

/// A camera of a mesh file, at its place in the node hierarchy, with axes of unit length in object space.
struct MeshCamera
{
    /// Of the camera, or of its node if it has none; and of the node.
    std::string name, node;
    Imath::V3d position { 0 }, right { 1, 0, 0 }, up { 0, 1, 0 }, forward { 0, 0, -1 };
    bool is_orthographic = false;
    /// Half the height of what it shows: at distance 1 in perspective, else in object units.
    double half_height = 0.5;
    /// Width over height; 0 if the file leaves it to the picture.
    double aspect = 0;
};

struct MeshOpacity;
struct MeshInstances;
struct Strands;

/// Triangles in object space (the file's own, right-handed, y up), counter-clockwise seen from outside. Every vertex
/// has a position and a unit normal. Vertices without texture coordinates have NaN in `uvs`; if none has any, `uvs` is
/// empty.
struct Mesh
{
    /// File name without its folder.
    std::string name;
    /// The path that the mesh was read from, for messages, or "".
    std::string path;
    /// In double: meshes far from the origin lose their shape in float. See read_mesh().
    std::vector<Imath::V3d> positions;
    /// The positions are the file's own, without rounding to float.
    bool has_exact_positions = false;
    std::vector<Imath::V3f> normals;
    /// v = 0 is the bottom of the texture, whatever the file's convention.
    std::vector<Imath::V2f> uvs;
    std::vector<std::array<uint32_t, 3>> triangles;
    /// For each triangle, an index into `materials`; empty if unknown.
    TriangleIndices triangle_materials;
    /// For each triangle, an index into `nodes`; empty if unknown.
    TriangleIndices triangle_nodes;
    /// The file's materials, in its order. Triangles without one have a material without a name.
    std::vector<Material> materials;
    /// What of it is not opaque; nullptr: all is. Reading a file leaves it so: see read_cutouts() of the stages.
    std::shared_ptr<const MeshOpacity> opacity;
    /// What an occluder has instead of triangles that is a file of strands; nullptr for none.
    std::shared_ptr<const Strands> strands;
    /// What else the file shows, and only casts: meshes in many places; nullptr: nothing. See read_instanced_mesh().
    std::shared_ptr<MeshInstances> instances;
    /// Parents come before their children.
    std::vector<MeshNode> nodes;
    /// Of formats whose reader knows them: glTF.
    std::vector<MeshCamera> cameras;
    /// Where the normals are from, in words: "from the file", "flat", "flat for 12 of 40 triangles, else from the
    /// file".
    std::string normals_from;
    /// What a user should know of how the file was read, one sentence each.
    std::vector<std::string> warnings;
};

struct MeshParams
{
    static constexpr double kFirstSample = -std::numeric_limits<double>::infinity();

    /// `file` keeps the file's normals, and computes missing ones as its format asks (see read_mesh()); `smooth` and
    /// `flat` compute all.
    std::string normals = "file";
    /// Smooth normals keep edges hard whose face normals differ by more than this, in degrees.
    double crease_angle = 180;
    /// 0 is the first UV set.
    int uv_set = 0;
    /// `file` follows the file's axis metadata; y is up in files without any.
    std::string up = "file";
    /// Of meshes that change over time: the frame to read, at `frame` / `fps` seconds. Beyond the ends of the animation
    /// it stands still. kFirstSample is the first sample of everything; as text, only the word "first" is.
    double frame = kFirstSample;
    double fps = 24;
    /// Of images of heights: the distance between pixels in mesh units, as "1.5m/px" or "1.5". "" refuses them.
    std::string terrain;
    /// Times what pixels say, in mesh units; integers say 0 to 1.
    double height_scale = 1;

    template <class Visit> void visit(Visit&& field)
    {
        field("normals", normals,
              Choices { { { "file", "from the mesh file; missing ones as its format asks" },
                          { "smooth", "averaged at each vertex, weighted by angle" },
                          { "flat", "one per triangle" } } },
              "Vertex normals");
        field("crease_angle", crease_angle, Range { 0, 180 },
              advanced("With smooth normals: edges sharper than this, in degrees, stay hard"));
        field("uv_set", uv_set, Range { 0, 7 }, "UV set to bake; 0 is the first");
        field("up", up,
              Choices { { { "file", "from the file's metadata, otherwise y" },
                          { "y", "y is up: no rotation" },
                          { "z", "z is up: rotate to y up" } } },
              "Up axis of the mesh");
        field("frame", frame, Range { -999999, 999999, "first", kFirstSample },
              "Frame of an animated Alembic mesh and its occluders; may have a fraction. first: the first sample");
        field("fps", fps, Range { 1e-3, 1e4 }, advanced("Frame rate of the mesh's animation, for frame"));
        field("terrain", terrain, Text { "DISTANCE" },
              "Read images as terrain, with this distance between pixels in mesh units, as in 1.5m/px");
        field("height_scale", height_scale, Range { 1e-9, 1e9 },
              "Height of a pixel with the value 1, in mesh units; integer pixels have 0 to 1");
    }
};

/// Can the mesh be baked, or occlude? False, with the reason in `error`, if a triangle uses a vertex that does not
/// exist or is not finite (the first is named), if the counts of positions, normals and uvs (if any) differ, or if its
/// strands fail check_strands().
VMLIGHT_API bool check_mesh(const Mesh& mesh, std::string& error);

/// Give each triangle of `mesh` one normal. Splits vertices as needed.
VMLIGHT_API void make_flat_normals(Mesh& mesh);

/// Give `mesh` smooth normals: angle-weighted over all triangles that share a position (equal bit for bit) and whose
/// normals differ by at most `crease_angle` degrees. Splits vertices as needed. Vertices that only triangles without
/// area use get the zero vector.
/// Source: G. Thuermer, C. Wuethrich, "Computing Vertex Normals from Polygonal Facets", JGT 3(1), 1998.
VMLIGHT_API void make_smooth_normals(Mesh& mesh, double crease_angle);

/// Whether a normal is missing: normals are of unit length, or zero.
inline bool is_missing_normal(const Imath::V3f& normal)
{
    return !(normal.length2() > 0.25f);
}

/// The smoothing group of triangles with flat normals.
constexpr uint32_t kFlatGroup = 0;

/// As make_smooth_normals(), but only for vertices whose normal is zero.
/// @param groups   a smoothing group for each triangle: normals are smooth across triangles of one group, and those of
///                 kFlatGroup flat; empty: all are of one group
/// @param seam_angle   where triangles that meet differ in their uvs, edges sharper than this, in degrees, stay hard
VMLIGHT_API void fill_missing_normals(Mesh& mesh, double crease_angle, const TriangleIndices& groups = {},
                                      double seam_angle = 180);

/// Merge vertices whose position, normal and uv agree bit for bit, and order them by first use.
VMLIGHT_API void merge_equal_vertices(Mesh& mesh);

/// A 64-bit hash of positions, normals, uvs and triangles, or of strands, as 16 hexadecimal digits. The same on every
/// little-endian machine.
VMLIGHT_API std::string mesh_hash(const Mesh& mesh);

/// Whether a vertex has texture coordinates.
inline bool has_uv(const Mesh& mesh, uint32_t vertex)
{
    return !mesh.uvs.empty() && std::isfinite(mesh.uvs[vertex].x) && std::isfinite(mesh.uvs[vertex].y);
}

/// The normal of a triangle times twice its area; zero for a triangle without area.
inline Imath::V3d triangle_area_normal(const Mesh& mesh, const std::array<uint32_t, 3>& triangle)
{
    const Imath::V3d& a = mesh.positions[triangle[0]];
    return (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a);
}

} // namespace vmlight
