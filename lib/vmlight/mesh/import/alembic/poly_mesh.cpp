// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/alembic/poly_mesh.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/alembic/error.h>

#include <algorithm>

namespace vmlight::alembic {
namespace {

using Imath::V3d;

const char* const kGeom = ".geom";

bool has_schema(const AbcA::ObjectHeader& header, const char* schema)
{
    return header.getMetaData().get("schema") == schema;
}

AbcA::ArrayPropertyReaderPtr need_array(const AbcA::CompoundPropertyReaderPtr& geom, const char* name)
{
    auto array = find_array(geom, name);
    if (!array)
        throw Error(format("has no \"{}\"", name));
    return array;
}

Faces read_faces(const AbcA::CompoundPropertyReaderPtr& geom, Moment& moment, size_t vertices)
{
    Faces faces;
    const auto counts = need_array(geom, ".faceCounts"), indices = need_array(geom, ".faceIndices");
    faces.vertices = vertices;
    faces.is_constant = counts->isConstant() && indices->isConstant();
    const std::vector<int32_t> corners = read_array<int32_t>(*indices, samples_at(*indices, moment).first);
    uint64_t end = 0;
    for (const int32_t count : read_array<int32_t>(*counts, samples_at(*counts, moment).first)) {
        end += uint64_t(std::max(count, 0));
        if (count < 0 || end > corners.size())
            throw Error(format("face {} has {} corners, but {} are left", faces.ends.size(), count,
                               corners.size() - (end - uint64_t(std::max(count, 0)))));
        faces.ends.push_back(uint32_t(end));
    }
    if (end != corners.size())
        throw Error(format("its faces have {} corners, but there are {}", end, corners.size()));
    for (const int32_t vertex : corners) {
        if (vertex < 0 || size_t(vertex) >= vertices)
            throw Error(format("a face uses vertex {}, but there are only {}", vertex, vertices));
        faces.corners.push_back(uint32_t(vertex));
    }
    return faces;
}

void read_face_sets(PolyMesh& dst, AbcA::ObjectReader& object, Moment& moment)
{
    dst.face_set.assign(dst.faces.ends.size(), -1);
    bool is_shared = false;
    for (size_t i = 0; i < object.getNumChildren(); ++i) {
        if (!is_face_set(object.getChildHeader(i)))
            continue;
        const AbcA::ObjectReaderPtr set = object.getChild(i);
        const auto faces = find_array(find_compound(set->getProperties(), ".faceset"), ".faces");
        const int number = int(dst.face_sets.size());
        dst.face_sets.push_back(set->getName());
        if (!faces)
            continue;
        for (const int32_t face : read_array<int32_t>(*faces, samples_at(*faces, moment).first)) {
            if (face < 0 || size_t(face) >= dst.face_set.size())
                throw Error(format("face set \"{}\" has face {}, but there are only {}", set->getName(), face,
                                   dst.face_set.size()));
            is_shared = is_shared || (dst.face_set[size_t(face)] != -1 && dst.face_set[size_t(face)] != number);
            if (dst.face_set[size_t(face)] == -1)
                dst.face_set[size_t(face)] = number;
        }
    }
    if (is_shared)
        dst.faults.emplace_back("some faces are in several face sets: the first is their material");
}

void read_holes(PolyMesh& dst, const AbcA::CompoundPropertyReaderPtr& geom, Moment& moment)
{
    const auto holes = find_array(geom, ".holes");
    if (!holes)
        return;
    dst.is_hole.assign(dst.faces.ends.size(), false);
    for (const int32_t face : read_array<int32_t>(*holes, samples_at(*holes, moment).first))
        if (face >= 0 && size_t(face) < dst.is_hole.size())
            dst.is_hole[size_t(face)] = true;
}

// Clockwise faces become counter-clockwise, and the other way round.
void turn_faces(PolyMesh& mesh)
{
    for (std::vector<uint32_t>* of_corners : { &mesh.faces.corners, &mesh.uvs.values, &mesh.normals.values }) {
        if (of_corners->empty())
            continue;
        auto begin = of_corners->begin();
        for (const uint32_t last : mesh.faces.ends) {
            const auto end = of_corners->begin() + last;
            std::reverse(begin, end);
            begin = end;
        }
    }
}

} // namespace

bool is_poly_mesh(const AbcA::ObjectHeader& header)
{
    return has_schema(header, "AbcGeom_PolyMesh_v1");
}

bool is_subdivision_surface(const AbcA::ObjectHeader& header)
{
    return has_schema(header, "AbcGeom_SubD_v1");
}

bool is_face_set(const AbcA::ObjectHeader& header)
{
    return has_schema(header, "AbcGeom_FaceSet_v1");
}

PolyMesh read_poly_mesh(AbcA::ObjectReader& object, Moment& moment, int uv_set)
{
    PolyMesh mesh;
    const auto geom = find_compound(object.getProperties(), kGeom);
    const auto points = need_array(geom, "P");
    const SamplePair pair = samples_at(*points, moment);
    std::vector<float> numbers = read_array<float>(*points, pair.first, 3);
    mesh.faces = read_faces(geom, moment, numbers.size() / 3);
    if (pair.weight > 0 && mesh.faces.is_constant)
        numbers = blend(std::move(numbers), read_array<float>(*points, pair.second, 3), pair.weight);
    for (size_t i = 0; i < numbers.size(); i += 3)
        mesh.positions.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);

    const auto keep = [&](const std::string& fault) {
        if (!fault.empty())
            mesh.faults.push_back(fault);
    };
    std::string uv_fault, normal_fault;
    const std::vector<UvSet> sets = uv_sets(geom);
    if (uv_set >= 0 && size_t(uv_set) < sets.size())
        mesh.uvs = read_geom_param(sets[size_t(uv_set)].parent, sets[size_t(uv_set)].name, 2, mesh.faces, moment, false,
                                   uv_fault);
    mesh.normals = read_geom_param(geom, "N", 3, mesh.faces, moment, true, normal_fault);
    keep(uv_fault);
    keep(normal_fault);
    read_face_sets(mesh, object, moment);
    if (is_subdivision_surface(object.getHeader()))
        read_holes(mesh, geom, moment);
    turn_faces(mesh);
    return mesh;
}

} // namespace vmlight::alembic
