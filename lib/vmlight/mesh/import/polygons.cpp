// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/polygons.h>

#include <vmlight/base/text_format.h>

#include <assimp/BaseImporter.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace vmlight {
namespace {

using Imath::V3d;

struct Cut
{
    uint32_t polygon;
    std::array<uint32_t, 3> corners;
};

// A polygon for assimp, of vertices of its own.
struct Polygon
{
    uint32_t number, begin, end;
};

// Offsets between such are finite too.
bool has_finite_offsets(const V3d& p)
{
    constexpr double kFarthest = 1e300;
    return std::abs(p.x) < kFarthest && std::abs(p.y) < kFarthest && std::abs(p.z) < kFarthest;
}

// Hands assimp polygons as if they came from a file.
class PolygonImporter : public Assimp::BaseImporter
{
public:
    std::unique_ptr<aiScene> next;

    bool CanRead(const std::string&, Assimp::IOSystem*, bool) const override { return true; }
    const aiImporterDesc* GetInfo() const override
    {
        static const aiImporterDesc description { "polygons", "", "", "", 0, 0, 0, 0, 0, "polygons" };
        return &description;
    }

protected:
    void InternReadFile(const std::string&, aiScene* dst, Assimp::IOSystem*) override
    {
        std::swap(dst->mRootNode, next->mRootNode);
        std::swap(dst->mNumMeshes, next->mNumMeshes);
        std::swap(dst->mMeshes, next->mMeshes);
        std::swap(dst->mNumMaterials, next->mNumMaterials);
        std::swap(dst->mMaterials, next->mMaterials);
    }
};

// Says that every file exists, and opens none.
class NoFiles : public Assimp::IOSystem
{
public:
    bool Exists(const char*) const override { return true; }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
    void Close(Assimp::IOStream*) override { }
};

class Triangulator
{
public:
    Triangulator(const std::function<V3d(uint32_t)>& position, bool is_far)
        : m_position(position)
        , m_is_far(is_far)
    {
        for (size_t i = m_importer.GetImporterCount(); i-- > 0;) {
            const std::unique_ptr<Assimp::BaseImporter> other(m_importer.GetImporter(i));
            m_importer.UnregisterLoader(other.get());
        }
        m_importer.RegisterLoader(m_source); // which owns it from here on
        m_importer.SetIOHandler(&m_files);
    }
    ~Triangulator() { m_importer.SetIOHandler(nullptr); }

    bool cut(const std::vector<Polygon>& polygons, std::vector<Cut>& cuts, std::string& error);

private:
    std::unique_ptr<aiScene> scene_of(const std::vector<Polygon>& polygons);
    void set_vertices(aiVector3D* dst, const Polygon& polygon);

    const std::function<V3d(uint32_t)>& m_position;
    const bool m_is_far;
    Assimp::Importer m_importer;
    PolygonImporter* m_source = new PolygonImporter;
    NoFiles m_files;
    std::vector<uint32_t> m_corners, m_numbers; // corner and polygon of each vertex
};

// Assimp 5.4 drops polygons of five and more corners whose ears have areas below 1e-6, and areas beyond float are
// infinite: polygons are cut at a size of 2^30, scaled by a power of two.
void Triangulator::set_vertices(aiVector3D* dst, const Polygon& polygon)
{
    const V3d origin = m_is_far ? m_position(polygon.begin) : V3d(0);
    double reach = 0;
    for (uint32_t corner = polygon.begin; corner < polygon.end; ++corner)
        for (int k = 0; k < 3; ++k)
            reach = std::max(reach, std::abs(m_position(corner)[k] - origin[k]));
    const int exponent = reach > 0 ? 30 - std::ilogb(reach) : 0;
    for (uint32_t corner = polygon.begin; corner < polygon.end; ++corner) {
        const V3d p = m_position(corner) - origin;
        *dst++ = aiVector3D(ai_real(std::ldexp(p.x, exponent)), ai_real(std::ldexp(p.y, exponent)),
                            ai_real(std::ldexp(p.z, exponent)));
    }
}

std::unique_ptr<aiScene> Triangulator::scene_of(const std::vector<Polygon>& polygons)
{
    m_corners.clear();
    m_numbers.clear();
    auto scene = std::make_unique<aiScene>();
    scene->mRootNode = new aiNode;
    scene->mRootNode->mNumMeshes = 1;
    scene->mRootNode->mMeshes = new unsigned[1] { 0 };
    scene->mNumMaterials = 1;
    scene->mMaterials = new aiMaterial* [1] { new aiMaterial };
    scene->mNumMeshes = 1;
    scene->mMeshes = new aiMesh* [1] { new aiMesh };
    aiMesh& part = *scene->mMeshes[0];
    part.mPrimitiveTypes = aiPrimitiveType_POLYGON;
    for (const Polygon& polygon : polygons)
        part.mNumVertices += polygon.end - polygon.begin;
    part.mVertices = new aiVector3D[part.mNumVertices];
    part.mNumFaces = unsigned(polygons.size());
    part.mFaces = new aiFace[part.mNumFaces];
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
        const Polygon& polygon = polygons[f];
        aiFace& face = part.mFaces[f];
        face.mNumIndices = polygon.end - polygon.begin;
        face.mIndices = new unsigned[face.mNumIndices];
        set_vertices(part.mVertices + m_corners.size(), polygon);
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            face.mIndices[k] = unsigned(m_corners.size());
            m_corners.push_back(polygon.begin + k);
            m_numbers.push_back(polygon.number);
        }
    }
    return scene;
}

bool Triangulator::cut(const std::vector<Polygon>& polygons, std::vector<Cut>& cuts, std::string& error)
{
    cuts.clear();
    if (polygons.empty())
        return true;
    m_source->next = scene_of(polygons);
    const aiScene* scene = m_importer.ReadFile("polygons", aiProcess_Triangulate);
    if (!scene || scene->mNumMeshes != 1) {
        error = "cannot cut polygons into triangles: " + shortened_line(m_importer.GetErrorString());
        return false;
    }
    const aiMesh& part = *scene->mMeshes[0];
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
        const aiFace& face = part.mFaces[f];
        if (face.mNumIndices == 3)
            cuts.push_back(
                { m_numbers[face.mIndices[0]],
                  { m_corners[face.mIndices[0]], m_corners[face.mIndices[1]], m_corners[face.mIndices[2]] } });
    }
    m_importer.FreeScene();
    return true;
}

} // namespace

int quad_diagonal(const std::array<V3d, 4>& corners)
{
    std::array<V3d, 3> edges; // from the first corner
    double reach = 0;
    for (size_t i = 0; i < 3; ++i) {
        edges[i] = corners[i + 1] - corners[0];
        for (int k = 0; k < 3; ++k)
            reach = std::max(reach, std::abs(edges[i][k]));
    }
    if (reach > 0) // products of four lengths would not be finite
        for (V3d& edge : edges)
            for (int k = 0; k < 3; ++k)
                edge[k] = std::ldexp(edge[k], -std::ilogb(reach));
    const V3d first = edges[0].cross(edges[1]), second = edges[1].cross(edges[2]), whole = first + second;
    return first.dot(whole) < 0 || second.dot(whole) < 0 ? 1 : 0;
}

bool visit_triangles(const std::vector<uint32_t>& ends, const std::function<V3d(uint32_t corner)>& position,
                     bool is_far, const TriangleVisitor& visit, std::string& error)
{
    constexpr size_t kBatch = 65536; // bounds the memory that assimp needs
    std::unique_ptr<Triangulator> triangulator;
    std::vector<Polygon> polygons;
    std::vector<Cut> cuts;
    size_t next = 0; // polygon that has not been visited
    const auto polygon_of = [&](size_t number) {
        return Polygon { uint32_t(number), number == 0 ? 0 : ends[number - 1], ends[number] };
    };
    const auto must_be_cut = [&](const Polygon& polygon) {
        bool is_good = polygon.end - polygon.begin > 4;
        for (uint32_t corner = polygon.begin; is_good && corner < polygon.end; ++corner)
            is_good = has_finite_offsets(position(corner)); // others are refused later: assimp need not see them
        return is_good;
    };
    const auto first_of_fan = [&](const Polygon& polygon) {
        const uint32_t a = polygon.begin;
        return polygon.end - a != 4 ? 0
                                    : quad_diagonal({ position(a), position(a + 1), position(a + 2), position(a + 3) });
    };
    const auto visit_until = [&](size_t end) {
        if (!polygons.empty() && !triangulator)
            triangulator = std::make_unique<Triangulator>(position, is_far);
        if (!polygons.empty() && !triangulator->cut(polygons, cuts, error))
            return false;
        size_t given = 0, cut = 0;
        for (; next < end; ++next) {
            if (given < polygons.size() && polygons[given].number == next) {
                for (++given; cut < cuts.size() && cuts[cut].polygon == next; ++cut)
                    visit(next, cuts[cut].corners);
                continue;
            }
            const Polygon fan = polygon_of(next);
            const auto first = uint32_t(first_of_fan(fan));
            const uint32_t corners = fan.end - fan.begin;
            for (uint32_t k = 2; k < corners; ++k)
                visit(next, { fan.begin + first, fan.begin + k - 1 + first, fan.begin + (k + first) % corners });
        }
        polygons.clear();
        cuts.clear();
        return true;
    };
    for (size_t i = 0; i < ends.size(); ++i) {
        if (const Polygon polygon = polygon_of(i); must_be_cut(polygon))
            polygons.push_back(polygon);
        if (polygons.size() == kBatch && !visit_until(i + 1))
            return false;
    }
    return visit_until(ends.size());
}

} // namespace vmlight
