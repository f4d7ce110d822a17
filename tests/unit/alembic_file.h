// SPDX-License-Identifier: Apache-2.0
/// Alembic files, written by the Alembic library.
#pragma once

#include "mesh_fixture.h"

#include <Alembic/AbcCoreOgawa/All.h>
#include <Alembic/AbcGeom/All.h>

#include <Imath/ImathMatrix.h>

#include <cstdint>
#include <list>
#include <string>
#include <utility>
#include <vector>

namespace alembic_files {

namespace Abc = ::Alembic::AbcGeom; // has all names of the layers below it
using Imath::M44d;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

/// Times of samples: a frame at 24 per second.
inline const Abc::TimeSampling kFilm(1.0 / 24, 1.0 / 24);

/// Samples refer to their values: these stay.
template <class Value> const std::vector<Value>& kept(std::vector<Value> values)
{
    static std::list<std::vector<Value>> all;
    return all.emplace_back(std::move(values));
}

using Values = std::vector<V2f>;

/// Texture coordinates, by index if `indices` are given.
inline Abc::OV2fGeomParam::Sample uvs(const Values& values, Abc::GeometryScope scope,
                                      const std::vector<uint32_t>& indices = {})
{
    Abc::OV2fGeomParam::Sample sample;
    sample.setVals(Abc::V2fArraySample(kept(values)));
    sample.setScope(scope);
    if (!indices.empty())
        sample.setIndices(Abc::UInt32ArraySample(kept(indices)));
    return sample;
}

/// The polygons of one sample. Alembic's faces are clockwise seen from outside.
struct Polygons
{
    std::vector<V3f> points;
    std::vector<int32_t> corners, counts;
    Abc::OV2fGeomParam::Sample uvs;
    Abc::ON3fGeomParam::Sample normals;

    Abc::OPolyMeshSchema::Sample sample() const
    {
        Abc::OPolyMeshSchema::Sample all { Abc::P3fArraySample(points), Abc::Int32ArraySample(corners),
                                           Abc::Int32ArraySample(counts) };
        all.setUVs(uvs);
        all.setNormals(normals);
        return all;
    }
};

/// A quad 2 wide and 3 high in z = 0, facing +z.
inline Polygons quad()
{
    return { { V3f(0, 0, 0), V3f(2, 0, 0), V3f(2, 3, 0), V3f(0, 3, 0) }, { 3, 2, 1, 0 }, { 4 }, {}, {} };
}

inline Polygons moved(Polygons polygons, const V3f& by)
{
    for (V3f& point : polygons.points)
        point += by;
    return polygons;
}

/// An archive that is finished when it goes.
class Archive
{
public:
    explicit Archive(const std::string& path)
        : m_archive(::Alembic::AbcCoreOgawa::WriteArchive(), path)
    {
    }

    Abc::OObject top() { return m_archive.getTop(); }

    static Abc::OPolyMesh add_mesh(const Abc::OObject& parent, const std::string& name,
                                   const std::vector<Polygons>& samples)
    {
        Abc::OPolyMesh mesh(parent, name, Abc::TimeSamplingPtr(new Abc::TimeSampling(kFilm)));
        for (const Polygons& sample : samples)
            mesh.getSchema().set(sample.sample());
        return mesh;
    }

    static Abc::OXform add_xform(const Abc::OObject& parent, const std::string& name,
                                 const std::vector<Abc::XformSample>& samples)
    {
        Abc::OXform xform(parent, name, Abc::TimeSamplingPtr(new Abc::TimeSampling(kFilm)));
        for (Abc::XformSample sample : samples)
            xform.getSchema().set(sample);
        return xform;
    }

    static Abc::XformSample translation(const V3d& by)
    {
        Abc::XformSample sample;
        sample.setTranslation(by);
        return sample;
    }

private:
    Abc::OArchive m_archive;
};

/// A file of one mesh at the top.
inline std::string mesh_file(const std::string& path, const std::vector<Polygons>& samples)
{
    Archive archive(path);
    Archive::add_mesh(archive.top(), "leaf", samples);
    return path;
}

} // namespace alembic_files
