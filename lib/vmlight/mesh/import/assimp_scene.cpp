// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/assimp_scene.h>

#include <vmlight/mesh/import/import.h>
#include <vmlight/mesh/import/scene_fault.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace vmlight {
namespace {

using Imath::V3d;
using OIIO::Strutil::fmt::format;

// Assimp 5.4 drops polygons of five and more corners whose ears have areas of less than 1e-6, and areas beyond float
// are infinite: polygons are cut in meshes of 2^30, brought there by powers of two, so that not a bit is lost but below
// 2^-149 of what is there.
std::vector<int> exponents_of_parts(const aiScene& scene)
{
    std::vector<int> exponents;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& part = *scene.mMeshes[m];
        float reach = 0;
        for (unsigned i = 0; i < part.mNumVertices; ++i)
            for (int k = 0; k < 3; ++k)
                reach = std::max(reach, std::abs(part.mVertices[i][k]));
        exponents.push_back(reach > 0 ? std::clamp(30 - std::ilogb(reach), -97, 126) : 0);
    }
    return exponents;
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

// A vertex that a face uses: others may lie anywhere.
V3d corner_of(const aiMesh& part, const std::vector<V3d>& positions)
{
    for (unsigned f = 0; f < part.mNumFaces; ++f)
        if (part.mFaces[f].mNumIndices > 0)
            return positions[part.mFaces[f].mIndices[0]];
    return V3d(0);
}

// Give the scene the file's own vertices, about one of them where they are floats, and set `exact` to them in double.
// False if the importer made other vertices than the file has.
bool restore_positions(aiScene& scene, const MeshFile& file, ExactPositions& exact)
{
    if (file.positions.empty())
        return true;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        aiMesh& part = *scene.mMeshes[m];
        exact.emplace_back();
        for (unsigned i = 0; i < part.mNumVertices; ++i) {
            const aiVector3D& v = part.mVertices[i];
            const size_t number = file.is_numbered ? size_t(v.x) + (size_t(v.y) << 16) : i;
            if (number >= file.positions.size())
                return false;
            exact.back().push_back(file.positions[number]);
        }
        const V3d centre = corner_of(part, exact.back());
        for (unsigned i = 0; i < part.mNumVertices; ++i) {
            const V3d about = exact.back()[i] - centre;
            part.mVertices[i] = aiVector3D(ai_real(about.x), ai_real(about.y), ai_real(about.z));
        }
    }
    return true;
}

// Leaves the importer those formats whose files are looked at before it sees them, or that cannot name a part of
// themselves. Of others (X3D, 3MF, glTF 1.0, ...) a short file can make assimp go round for ever.
void keep_known_formats(Assimp::Importer& importer)
{
    const std::vector<std::string> known { "obj", "ply", "stl", "dae", "fbx" }; // of each importer's, the first
    for (size_t i = importer.GetImporterCount(); i-- > 0;) {
        const aiImporterDesc& description = *importer.GetImporterInfo(i);
        const std::vector<std::string> extensions = OIIO::Strutil::splits(description.mFileExtensions);
        const bool is_known
            = !extensions.empty() && std::find(known.begin(), known.end(), extensions.front()) != known.end();
        if (is_known || OIIO::Strutil::starts_with(description.mName, "glTF2"))
            continue;
        const std::unique_ptr<Assimp::BaseImporter> unknown(importer.GetImporter(i)); // ours once it is not listed
        importer.UnregisterLoader(unknown.get());
    }
}

// Files, and who wants to be told of them; of one its stand-in. By holding assimp's own, which may not be derived from
// in assimp 6.
class ToldFiles : public Assimp::IOSystem
{
public:
    ToldFiles(const std::function<void(const std::string& path)>& opens, const std::string& path,
              const std::string& stand_in)
        : m_opens(opens)
        , m_path(path)
        , m_stand_in(stand_in)
    {
    }
    Assimp::IOStream* Open(const char* path, const char* mode) override
    {
        if (m_opens)
            m_opens(path);
        if (!m_stand_in.empty() && path == m_path)
            return new Assimp::MemoryIOStream(reinterpret_cast<const uint8_t*>(m_stand_in.data()), m_stand_in.size());
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
    const std::string &m_path, &m_stand_in;
    Assimp::DefaultIOSystem m_files;
};

} // namespace

const aiScene* read_scene(Assimp::Importer& importer, const std::string& path, ExactPositions& exact,
                          const std::function<void(const std::string& path)>& opens, std::string& error)
{
    const auto fail = [&](const std::string& reason) {
        error = reason;
        return nullptr;
    };
    const auto fail_to_read = [&] {
        const std::string reason = importer.GetErrorString();
        return OIIO::Strutil::starts_with(reason, "No suitable reader")
            ? fail("not a mesh that can be read: none of OBJ, PLY, STL, glTF 2.0, Collada, FBX")
            : fail(format("not a mesh that can be read: {}", reason));
    };
    const MeshFile file = inspect_mesh_file(path);
    if (!file.fault.empty())
        return fail(file.fault);
    keep_known_formats(importer);
    ToldFiles files(opens, path, file.stand_in);
    importer.SetIOHandler(&files);
    const bool read = importer.ReadFile(path, 0);
    importer.SetIOHandler(nullptr); // gives it back
    if (!read)
        return fail_to_read();
    aiScene& scene = const_cast<aiScene&>(*importer.GetScene());
    if (const std::string fault = mesh_scene_fault(scene); !fault.empty())
        return fail(fault);
    correct_primitive_types(scene);
    if (!restore_positions(scene, file, exact))
        return fail("not a mesh that can be read: vertices that the file has not");
    const std::vector<int> exponents = exponents_of_parts(scene);
    scale_parts(scene, exponents, 1);
    if (!importer.ApplyPostProcessing(aiProcess_Triangulate) || !scene.mRootNode)
        return fail_to_read();
    scale_parts(scene, exponents, -1);
    return &scene;
}

} // namespace vmlight
