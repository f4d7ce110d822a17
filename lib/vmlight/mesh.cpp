// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh.h>

#include <vmlight/mesh_file_fault.h>
#include <vmlight/mesh_scene_fault.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/hash.h>
#include <OpenImageIO/strutil.h>

#include <Imath/ImathMatrix.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

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

// Assimp's matrices multiply column vectors; Imath's multiply rows: transposed here, composed in double.
Imath::M44d matrix_of(const aiMatrix4x4& m)
{
    return Imath::M44d(m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4);
}

struct Reading
{
    Reading(Mesh& dst, int set)
        : mesh(dst)
        , uv_set(set)
    {
    }

    Mesh& mesh;
    int uv_set;
    bool has_uvs = false;
    std::string error;

    void append(const aiMesh& part, const Imath::M44d& to_object);
    void append(const aiScene& scene, const aiNode& node, const Imath::M44d& parent);
};

void Reading::append(const aiMesh& part, const Imath::M44d& to_object)
{
    const uint32_t first = uint32_t(mesh.positions.size());
    const bool mirrored = to_object.determinant() < 0;
    const Imath::M44d normals_to_object = to_object.inverse().transposed();
    const float nan = std::numeric_limits<float>::quiet_NaN();

    for (unsigned i = 0; i < part.mNumVertices; ++i) {
        const aiVector3D& p = part.mVertices[i];
        V3d position;
        to_object.multVecMatrix(V3d(p.x, p.y, p.z), position);
        if (!is_finite(position) && error.empty())
            error = format("vertex {} of \"{}\" is not finite: ({}, {}, {})", i, part.mName.C_Str(), p.x, p.y, p.z);
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
        append(*scene.mMeshes[node.mMeshes[i]], to_object);
    for (unsigned i = 0; i < node.mNumChildren; ++i)
        append(scene, *node.mChildren[i], to_object);
}

// Multiply the positions of each part by 2^exponents of it, or by 2^-exponents.
void scale_parts(aiScene& scene, const std::vector<int>& exponents, int sign)
{
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        aiMesh& part = *scene.mMeshes[m];
        for (unsigned i = 0; i < part.mNumVertices; ++i)
            part.mVertices[i] *= std::ldexp(1.0f, sign * exponents[m]);
    }
}

// Assimp 5.4 drops polygons of five and more corners whose ears have areas of less than 1e-6: they are cut in meshes
// that are blown up to 2^30, by powers of two, so that not a bit is lost.
const aiScene* read_triangles(Assimp::Importer& importer, const std::string& path, std::string& error)
{
    const aiScene* read = importer.ReadFile(path, 0);
    error = read ? mesh_scene_fault(*read) : importer.GetErrorString();
    if (!error.empty())
        return nullptr;
    aiScene& scene = const_cast<aiScene&>(*read);
    correct_primitive_types(scene);
    std::vector<int> exponents;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& part = *scene.mMeshes[m];
        float reach = 0;
        for (unsigned i = 0; i < part.mNumVertices; ++i)
            for (int k = 0; k < 3; ++k)
                reach = std::max(reach, std::abs(part.mVertices[i][k]));
        exponents.push_back(reach > 0 ? std::clamp(30 - std::ilogb(reach), 0, 126) : 0);
    }
    scale_parts(scene, exponents, 1);
    if (!importer.ApplyPostProcessing(aiProcess_Triangulate)) {
        error = importer.GetErrorString();
        return nullptr;
    }
    scale_parts(scene, exponents, -1);
    return &scene;
}

// Files, and who wants to be told of them. By holding assimp's own, which may not be derived from in assimp 6.
class ToldFiles : public Assimp::IOSystem
{
public:
    explicit ToldFiles(const std::function<void(const std::string& path)>& opens)
        : m_opens(opens)
    {
    }
    Assimp::IOStream* Open(const char* path, const char* mode) override
    {
        if (m_opens)
            m_opens(path);
        if (!OIIO::Filesystem::is_regular(path))
            return nullptr; // a pipe among the files that a mesh names would hold its reader up
        return m_files.Open(path, mode);
    }
    // Assimp's own opens it to see.
    bool Exists(const char* path) const override { return OIIO::Filesystem::is_regular(path); }
    char getOsSeparator() const override { return m_files.getOsSeparator(); }
    void Close(Assimp::IOStream* file) override { m_files.Close(file); }

private:
    const std::function<void(const std::string& path)>& m_opens;
    Assimp::DefaultIOSystem m_files;
};

bool is_z_up(const aiScene& scene, const std::string& up)
{
    int axis = 1;
    if (up == "file" && scene.mMetaData)
        scene.mMetaData->Get("UpAxis", axis);
    return up == "z" || axis == 2;
}

} // namespace

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
    const std::string fault = mesh_file_fault(path);
    if (!fault.empty()) {
        error = format("\"{}\": {}", path, fault);
        return false;
    }
    Assimp::Importer importer;
    importer.SetIOHandler(new ToldFiles(opens)); // the importer deletes it
    // Assimp's own merging of vertices and smoothing of normals compare positions within an absolute or a coarse
    // relative distance, which collapses small meshes: both are done here, on equal bits.
    const aiScene* scene = read_triangles(importer, path, error);
    if (!scene || !scene->mRootNode) {
        error = format("\"{}\": not a mesh that can be read: {}", path, error);
        return false;
    }

    Imath::M44d to_y_up;
    if (is_z_up(*scene, params.up))
        to_y_up = Imath::M44d(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1); // (x, y, z) -> (x, z, -y)
    Reading reading(dst, params.uv_set);
    reading.append(*scene, *scene->mRootNode, to_y_up);
    if (!reading.error.empty() || dst.triangles.empty()) {
        error = format("\"{}\": {}", path, reading.error.empty() ? "no triangle in it" : reading.error);
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

std::string mesh_hash(const Mesh& mesh)
{
    const auto fingerprint = [](const auto& elements) {
        const char* bytes = reinterpret_cast<const char*>(elements.data());
        return OIIO::farmhash::Fingerprint64(bytes, elements.size() * sizeof(elements[0]));
    };
    const std::array<uint64_t, 4> parts { fingerprint(mesh.positions), fingerprint(mesh.normals), fingerprint(mesh.uvs),
                                          fingerprint(mesh.triangles) };
    const uint64_t hash = fingerprint(parts);
    return format("{:016x}", hash);
}

} // namespace vmlight
