// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/read_mesh.h>

#include <vmlight/base/deep_stack.h>
#include <vmlight/base/words.h>
#include <vmlight/mesh/import/mesh_of_scene.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <Imath/ImathMatrix.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace vmlight {
namespace {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;
using OIIO::Strutil::fmt::format;

bool is_finite(const V3d& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Where areas and their squares still fit a double. No float is farther off.
bool is_near_enough(const V3d& v)
{
    constexpr double kFarthest = 1e70;
    return std::abs(v.x) <= kFarthest && std::abs(v.y) <= kFarthest && std::abs(v.z) <= kFarthest;
}

// Assimp's matrices multiply column vectors; Imath's multiply rows: transposed here, composed in double.
Imath::M44d matrix_of(const aiMatrix4x4& m)
{
    return Imath::M44d(m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4);
}

V3d to_double(const aiVector3D& v)
{
    return V3d(v.x, v.y, v.z);
}

struct Reading
{
    Reading(Mesh& dst, int set, const ExactPositions& positions)
        : mesh(dst)
        , uv_set(set)
        , exact(positions)
    {
    }

    Mesh& mesh;
    int uv_set;
    const ExactPositions& exact;
    bool has_uvs = false;
    std::string error;

    void append(const aiScene& scene, unsigned number, const Imath::M44d& to_object);
    void append(const aiScene& scene, const aiNode& node, const Imath::M44d& parent);
};

void Reading::append(const aiScene& scene, unsigned number, const Imath::M44d& to_object)
{
    const aiMesh& part = *scene.mMeshes[number];
    const uint32_t first = uint32_t(mesh.positions.size());
    const bool mirrored = to_object.determinant() < 0;
    const Imath::M44d normals_to_object = to_object.inverse().transposed();
    const float nan = std::numeric_limits<float>::quiet_NaN();

    for (unsigned i = 0; i < part.mNumVertices; ++i) {
        const V3d own = exact.empty() ? to_double(part.mVertices[i]) : exact[number][i];
        V3d position;
        to_object.multVecMatrix(own, position);
        if (!is_near_enough(position) && error.empty()) {
            const V3d& told = is_near_enough(own) ? position : own;
            error = format("vertex {} of \"{}\" is {}{}: ({}, {}, {})", i, part.mName.C_Str(),
                           is_finite(told) ? "farther than 1e70 from the origin" : "not finite",
                           is_near_enough(own) ? " where its node puts it" : "", told.x, told.y, told.z);
        }
        mesh.positions.push_back(position);

        V3d normal(0);
        if (part.HasNormals()) {
            const aiVector3D& n = part.mNormals[i];
            normals_to_object.multDirMatrix(V3d(n.x, n.y, n.z), normal);
            normal = is_finite(normal) ? normal.normalized() : V3d(0);
        }
        mesh.normals.push_back(V3f(normal));

        const bool has_uv = part.HasTextureCoords(unsigned(uv_set));
        const aiVector3D* uv = has_uv ? &part.mTextureCoords[uv_set][i] : nullptr;
        mesh.uvs.push_back(uv ? V2f(uv->x, uv->y) : V2f(nan, nan));
        has_uvs |= has_uv;
    }

    for (unsigned i = 0; i < part.mNumFaces; ++i) {
        const aiFace& face = part.mFaces[i];
        if (face.mNumIndices != 3)
            continue; // a point or a line
        std::array<uint32_t, 3> triangle { first + face.mIndices[0], first + face.mIndices[1],
                                           first + face.mIndices[2] };
        if (mirrored)
            std::swap(triangle[1], triangle[2]); // a mirror turns the winding inside out
        mesh.triangles.push_back(triangle);
        mesh.materials.push_back(part.mMaterialIndex);
    }
}

void Reading::append(const aiScene& scene, const aiNode& node, const Imath::M44d& parent)
{
    const Imath::M44d to_object = matrix_of(node.mTransformation) * parent;
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
        append(scene, node.mMeshes[i], to_object);
    for (unsigned i = 0; i < node.mNumChildren; ++i)
        append(scene, *node.mChildren[i], to_object);
}

bool is_z_up(const aiScene& scene, const std::string& up)
{
    int axis = 1;
    if (up == "file" && scene.mMetaData)
        scene.mMetaData->Get("UpAxis", axis);
    return up == "z" || axis == 2;
}

} // namespace

bool mesh_of_scene(Mesh& dst, const aiScene& scene, const ExactPositions& exact, const MeshParams& params,
                   std::string& error)
{
    Imath::M44d to_y_up;
    if (is_z_up(scene, params.up))
        to_y_up = Imath::M44d(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1); // (x, y, z) -> (x, z, -y)
    Reading reading(dst, params.uv_set, exact);
    reading.append(scene, *scene.mRootNode, to_y_up);
    dst.has_exact_positions = !exact.empty();
    if (!reading.error.empty() || dst.triangles.empty()) {
        error = reading.error.empty() ? "no triangle in it" : reason_line(reading.error);
        return false;
    }

    if (!reading.has_uvs)
        dst.uvs.clear();
    if (params.normals == "flat")
        make_flat_normals(dst);
    else if (params.normals == "smooth")
        make_smooth_normals(dst, params.crease_angle);
    else
        fill_missing_normals(dst, params.crease_angle);
    return true;
}

bool read_mesh(Mesh& dst, const std::string& path, const MeshParams& params, std::string& error,
               const std::function<void(const std::string& path)>& opens)
{
    dst = Mesh();
    dst.name = OIIO::Filesystem::filename(path);
    dst.path = path;
    if (!OIIO::Filesystem::is_regular(path)) {
        error = format("\"{}\": {}", path, OIIO::Filesystem::exists(path) ? "not a file" : "no such file");
        return false;
    }
    bool good = false;
    on_deep_stack([&] { // assimp goes down the tree of a scene by recursion
        Assimp::Importer importer;
        // Assimp's own merging of vertices and smoothing of normals compare positions within an absolute or a coarse
        // relative distance, which collapses small meshes: both are done here, on equal bits.
        ExactPositions exact;
        const aiScene* scene = read_scene(importer, path, exact, opens, error);
        good = scene && mesh_of_scene(dst, *scene, exact, params, error);
    });
    if (good)
        return true;
    error = format("\"{}\": {}", path, error);
    dst = Mesh();
    return false;
}

} // namespace vmlight
