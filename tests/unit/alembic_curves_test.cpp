// SPDX-License-Identifier: Apache-2.0
// Alembic curves, which are strands.
#include "alembic_file.h"

#include <vmlight/mesh/import/strands/read_strands.h>

#include <gmock/gmock.h>

using namespace mesh_files;
using namespace alembic_files;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

// Two curves, of two points and of three.
const std::vector<V3f> kPoints { { 0, 0, 0 }, { 0, 1, 0 }, { 2, 0, 0 }, { 2, 1, 0 }, { 2, 3, 0 } };

struct Widths
{
    std::vector<float> values;
    Abc::GeometryScope scope = Abc::kVertexScope;
    std::vector<uint32_t> indices {};
};

void add_curves(const Abc::OObject& parent, const std::string& name, const std::vector<std::vector<V3f>>& samples,
                const Widths& widths = {}, const std::vector<int32_t>& counts = { 2, 3 },
                Abc::CurvePeriodicity wrap = Abc::kNonPeriodic)
{
    Abc::OCurves curves(parent, name, Abc::TimeSamplingPtr(new Abc::TimeSampling(kFilm)));
    for (const std::vector<V3f>& points : samples) {
        Abc::OFloatGeomParam::Sample width;
        if (!widths.values.empty())
            width = Abc::OFloatGeomParam::Sample(Abc::FloatArraySample(kept(widths.values)), widths.scope);
        if (!widths.indices.empty())
            width.setIndices(Abc::UInt32ArraySample(kept(widths.indices)));
        curves.getSchema().set(Abc::OCurvesSchema::Sample(Abc::P3fArraySample(kept(points)),
                                                          Abc::Int32ArraySample(kept(counts)), Abc::kCubic, wrap, width,
                                                          {}, {}, Abc::kBsplineBasis));
    }
}

class AlembicCurves : public MeshFiles
{
protected:
    Strands strands(const std::string& path, const std::string& radius = "", double frame = MeshParams::kFirstSample)
    {
        Strands result;
        MeshParams params;
        params.frame = frame;
        std::string error;
        EXPECT_TRUE(read_strands(result, path, params, radius, error)) << error;
        return result;
    }
    std::string refused(const std::string& path)
    {
        Strands result;
        std::string error;
        EXPECT_FALSE(read_strands(result, path, {}, "0.1", error));
        return error;
    }
};

} // namespace

TEST_F(AlembicCurves, AreStrandsOfHalfTheirWidth)
{
    const std::string path = folder / "hair.abc";
    const std::pair<Widths, std::vector<double>> cases[] = {
        { { { .2f, .1f, .4f, .2f, .1f } }, { .1, .05, .2, .1, .05 } },
        { { { .2f, .4f }, Abc::kUniformScope }, { .1, .1, .2, .2, .2 } },
        { { { .5f }, Abc::kConstantScope }, { .25, .25, .25, .25, .25 } },
        { { { .2f, .4f }, Abc::kVertexScope, { 0, 1, 1, 0, 0 } }, { .1, .2, .2, .1, .1 } },
    };
    for (const auto& [widths, radii] : cases) {
        {
            Archive archive(path);
            add_curves(archive.top(), "hair", { kPoints }, widths);
        }
        EXPECT_TRUE(is_strand_file(path));
        const Strands hair = strands(path);
        EXPECT_THAT(hair.ends, ElementsAre(2u, 5u));
        ASSERT_EQ(hair.points.size(), kPoints.size());
        ASSERT_EQ(hair.radii.size(), kPoints.size());
        for (size_t i = 0; i < kPoints.size(); ++i) {
            EXPECT_EQ(hair.points[i], V3d(kPoints[i])) << i;
            EXPECT_NEAR(hair.radii[i], radii[i], 1e-7) << i;
        }
    }
    EXPECT_NEAR(strands(path, "0.3:0.1").radii[1], .1, 1e-12) << "the user's, not the file's";
}

TEST_F(AlembicCurves, AreWhereTheirParentsPutThem)
{
    const std::string path = folder / "placed.abc";
    {
        Archive archive(path);
        Abc::XformSample doubled = Archive::translation(V3d(10, 0, 0));
        doubled.setScale(V3d(2, 2, 2));
        add_curves(Archive::add_xform(archive.top(), "a", { doubled }), "hair", { kPoints }, { { .2f } });
        Abc::OXform hidden = Archive::add_xform(archive.top(), "b", { Archive::translation(V3d(0)) });
        Abc::CreateVisibilityProperty(hidden, 0).set(int8_t(Abc::kVisibilityHidden));
        add_curves(hidden, "hidden", { kPoints }, { { .2f } });
    }
    const Strands hair = strands(path);
    ASSERT_EQ(hair.count(), 2u);
    EXPECT_EQ(hair.points[4], V3d(14, 6, 0));
    EXPECT_NEAR(hair.radii[4], .2, 1e-7) << "as much larger as its place";
}

TEST_F(AlembicCurves, MoveWithTheFrame)
{
    const std::string path = folder / "moving.abc";
    {
        Archive archive(path);
        std::vector<V3f> moved = kPoints;
        for (V3f& point : moved)
            point.z += 2;
        add_curves(archive.top(), "hair", { kPoints, moved }, { { .2f } });
    }
    for (const auto& [frame, z] : { std::pair(1., 0.), { 1.5, 1. }, { 2., 2. } })
        EXPECT_NEAR(strands(path, "", frame).points[3].z, z, 1e-6) << frame;
}

TEST_F(AlembicCurves, BesideAMeshAreReadWhereARadiusAsksForThem)
{
    const std::string path = folder / "both.abc";
    {
        Archive archive(path);
        add_curves(archive.top(), "hair", { kPoints });
        Archive::add_mesh(archive.top(), "skin", { quad() });
    }
    EXPECT_FALSE(is_strand_file(path));
    EXPECT_FALSE(has_lines_alone(path));
    EXPECT_EQ(strands(path, "0.1").count(), 2u);
    EXPECT_EQ(read(path).triangles.size(), 2u);
    Strands result;
    std::string error;
    EXPECT_FALSE(read_strands(result, path, {}, "", error));
    EXPECT_THAT(error, HasSubstr("the file has no radius of its strands: give it by --radius ROOT:TIP"));
}

TEST_F(AlembicCurves, ThatCannotBeStrandsAreRefused)
{
    const std::string path = folder / "odd.abc";
    const auto file = [&](const std::vector<int32_t>& counts, Abc::CurvePeriodicity wrap = Abc::kNonPeriodic) {
        Archive archive(path);
        add_curves(archive.top(), "hair", { kPoints }, {}, counts, wrap);
        return path;
    };
    EXPECT_THAT(refused(file({ 2, 3 }, Abc::kPeriodic)),
                HasSubstr("\"/hair\": has closed curves, which are no strands"));
    EXPECT_THAT(refused(file({ 4, 1 })), HasSubstr("curve 1 has 1 point: a strand has at least two"));
    EXPECT_THAT(refused(file({ 2, 9 })), HasSubstr("curve 1 has 9 points, but only 3 are left"));
    EXPECT_THAT(refused(file({ 2, 2 })), HasSubstr("its curves have 4 points, but there are 5"));
    EXPECT_THAT(refused(mesh_file(path, { quad() })), HasSubstr("no strands: it shows no curves"));
}
