// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/assimp_importer.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/polygons.h>
#include <vmlight/mesh/import/side_files.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace vmlight {
namespace {

// The format's usual extension, which assimp's importers list first, too.
std::string extension_of(const ImportRequest& request)
{
    return OIIO::Strutil::splits(request.format.extensions).front();
}

// Leave `importer` the one importer of the format, if it was built with it: another that takes the file for its own
// would read what was not inspected, and a short X3D or 3MF can make assimp recurse for ever.
void keep_importer_of(const ImportRequest& request, Assimp::Importer& importer)
{
    for (size_t i = importer.GetImporterCount(); i-- > 0;) {
        const std::vector<std::string> extensions = OIIO::Strutil::splits(importer.GetImporterInfo(i)->mFileExtensions);
        if (!extensions.empty() && extensions.front() == extension_of(request))
            continue;
        const std::unique_ptr<Assimp::BaseImporter> other(importer.GetImporter(i)); // ours once it is not listed
        importer.UnregisterLoader(other.get());
    }
}

// The file under a name from which assimp guesses its format right.
std::string known_name(const ImportRequest& request)
{
    const std::string ending = "." + extension_of(request);
    return OIIO::Strutil::iends_with(request.path, ending) ? request.path : request.path + ending;
}

// Opens files for assimp, and reports each. Wraps assimp's own file system,
// which cannot be derived from in assimp 6.
class ReportedFiles : public Assimp::IOSystem
{
public:
    /// @param name     what assimp knows the mesh by
    ReportedFiles(const ImportRequest& request, std::string name)
        : m_request(request)
        , m_name(std::move(name))
    {
    }
    Assimp::IOStream* Open(const char* name, const char* mode) override
    {
        const std::string path = path_of(name);
        if (m_request.before_open)
            m_request.before_open(path);
        if (!OIIO::Filesystem::is_regular(path))
            return nullptr; // a pipe among the files that a mesh names would block
        return m_files.Open(path.c_str(), mode);
    }
    // Assimp's own would open the file.
    bool Exists(const char* name) const override { return OIIO::Filesystem::is_regular(path_of(name)); }
    char getOsSeparator() const override { return m_files.getOsSeparator(); }
    void Close(Assimp::IOStream* file) override { m_files.Close(file); }

private:
    std::string path_of(const char* name) const { return name == m_name ? m_request.path : name; }

    const ImportRequest& m_request;
    const std::string m_name;
    Assimp::DefaultIOSystem m_files;
};

// Assimp's own cut of a quad depends on how much it bends, which differs from pose to pose.
void cut_quads(aiMesh& part)
{
    unsigned quads = 0;
    for (unsigned f = 0; f < part.mNumFaces; ++f)
        quads += part.mFaces[f].mNumIndices == 4;
    if (quads == 0)
        return;
    auto faces = std::make_unique<aiFace[]>(part.mNumFaces + quads);
    aiFace* next = faces.get();
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
        aiFace& face = part.mFaces[f];
        if (face.mNumIndices != 4) {
            std::swap(next->mNumIndices, face.mNumIndices);
            std::swap(next->mIndices, face.mIndices);
            ++next;
            continue;
        }
        std::array<Imath::V3d, 4> corners;
        for (unsigned k = 0; k < 4; ++k) {
            const aiVector3D& p = part.mVertices[face.mIndices[k]];
            corners[k] = { p.x, p.y, p.z };
        }
        const auto first = unsigned(quad_diagonal(corners));
        for (unsigned k = 1; k < 3; ++k, ++next) {
            next->mNumIndices = 3;
            next->mIndices = new unsigned[3] { face.mIndices[first], face.mIndices[first + k],
                                               face.mIndices[(first + k + 1) % 4] };
        }
    }
    delete[] part.mFaces;
    part.mFaces = faces.release();
    part.mNumFaces += quads;
}

// Set what kinds of faces each part says it has to what it has. assimp 5.2 takes a face without corners for a polygon,
// and aborts when it finds no polygon to triangulate.
void correct_primitive_types(aiScene& imported)
{
    // A face without corners counts as a point: no type at all would have assimp look for itself.
    constexpr unsigned kTypes[] = { aiPrimitiveType_POINT, aiPrimitiveType_POINT, aiPrimitiveType_LINE,
                                    aiPrimitiveType_TRIANGLE, aiPrimitiveType_POLYGON };
    for (unsigned m = 0; m < imported.mNumMeshes; ++m) {
        aiMesh& part = *imported.mMeshes[m];
        part.mPrimitiveTypes = 0;
        for (unsigned f = 0; f < part.mNumFaces; ++f)
            part.mPrimitiveTypes |= kTypes[std::min(part.mFaces[f].mNumIndices, 4u)];
    }
}

// Assimp 5.4 drops polygons of five and more corners whose ears have areas below 1e-6, and areas beyond float are
// infinite: polygons are triangulated at a size of 2^30, scaled by powers of two, which lose no bit above 2^-149 of it.
std::vector<int> triangulation_exponents(const aiScene& imported)
{
    std::vector<int> exponents;
    for (unsigned m = 0; m < imported.mNumMeshes; ++m) {
        const aiMesh& part = *imported.mMeshes[m];
        float reach = 0;
        for (unsigned i = 0; i < part.mNumVertices; ++i)
            for (int k = 0; k < 3; ++k)
                reach = std::max(reach, std::abs(part.mVertices[i][k]));
        exponents.push_back(reach > 0 ? std::clamp(30 - std::ilogb(reach), -97, 126) : 0);
    }
    return exponents;
}

// Multiply the positions of each part by 2^(sign * its exponent).
void scale_parts(aiScene& imported, const std::vector<int>& exponents, int sign)
{
    for (unsigned m = 0; m < imported.mNumMeshes; ++m) {
        aiMesh& part = *imported.mMeshes[m];
        for (unsigned i = 0; i < part.mNumVertices; ++i)
            part.mVertices[i] *= std::ldexp(1.0f, sign * exponents[m]);
    }
}

bool triangulate(Assimp::Importer& importer, aiScene& imported)
{
    const std::vector<int> exponents = triangulation_exponents(imported);
    scale_parts(imported, exponents, 1);
    if (!importer.ApplyPostProcessing(aiProcess_Triangulate) || !imported.mRootNode)
        return false;
    scale_parts(imported, exponents, -1);
    return true;
}

} // namespace

bool read_with_assimp(MeshBuilder& dst, const ImportRequest& request, std::string& error)
{
    // No post-processing but triangulation: assimp's merging of vertices and smoothing of normals compare positions
    // within an absolute or a coarse relative distance, which collapses small meshes.
    Assimp::Importer importer;
    const auto fail = [&](const std::string& reason) {
        error = format("cannot read as {}: {}", request.format.name, reason);
        return false;
    };
    const auto fail_with_assimps_error = [&] {
        OIIO::string_view reason = importer.GetErrorString();
        if (OIIO::Strutil::istarts_with(reason, extension_of(request) + ": ")) // names the format once more
            reason.remove_prefix(reason.find(' ') + 1);
        return fail(shortened_line(reason));
    };
    keep_importer_of(request, importer);
    const std::string name = known_name(request);
    ReportedFiles files(request, name);
    importer.SetIOHandler(&files);
    const bool read = importer.ReadFile(name, 0);
    importer.SetIOHandler(nullptr); // gives it back
    if (!read)
        return fail_with_assimps_error();
    aiScene& imported = const_cast<aiScene&>(*importer.GetScene());
    if (const std::string reason = face_error(imported); !reason.empty())
        return fail(reason);
    for (unsigned m = 0; m < imported.mNumMeshes; ++m)
        cut_quads(*imported.mMeshes[m]);
    correct_primitive_types(imported);
    if (!triangulate(importer, imported))
        return fail_with_assimps_error();
    append_imported(dst, imported, OIIO::Filesystem::parent_path(request.path));
    return true;
}

} // namespace vmlight
