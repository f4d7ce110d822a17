// SPDX-License-Identifier: Apache-2.0
// Alembic meshes at one frame.
#include "alembic_file.h"

#include <gmock/gmock.h>

#include <cmath>

using namespace mesh_files;
using namespace alembic_files;
using testing::ElementsAre;

namespace {

MeshParams at_frame(double frame, double fps = 24)
{
    MeshParams params;
    params.frame = frame;
    params.fps = fps;
    return params;
}

} // namespace

TEST_F(MeshFiles, AnAlembicMeshIsReadAtItsFrame)
{
    // Frames 1, 2 and 3, as 1/24, 2/24 and 3/24 seconds.
    const std::string path
        = mesh_file(folder / "a.abc", { quad(), moved(quad(), V3f(0, 0, 8)), moved(quad(), V3f(0, 0, 10)) });
    const auto z = [&](const MeshParams& params) { return read(path, params).positions[0].z; };
    EXPECT_EQ(z({}), 0) << "the first sample";
    EXPECT_EQ(z(at_frame(1)), 0);
    EXPECT_EQ(z(at_frame(2)), 8);
    EXPECT_EQ(z(at_frame(3)), 10);
    EXPECT_NEAR(z(at_frame(1.5)), 4, 1e-6);
    EXPECT_NEAR(z(at_frame(2.25)), 8.5, 1e-6);
    EXPECT_NEAR(z(at_frame(5, 48)), 9, 1e-6) << "half way between 2 and 3 at 24 per second";
    EXPECT_EQ(z(at_frame(2, 23.976)), 8) << "a rounded rate is not between";
    EXPECT_EQ(z(at_frame(0)), 0);
    EXPECT_EQ(z(at_frame(100)), 10);
    EXPECT_TRUE(read(path, at_frame(3)).warnings.empty());
    EXPECT_THAT(read(path, at_frame(100)).warnings,
                ElementsAre("frame 100 is beyond the animation, which has frames 1 to 3 at 24 per second: its end "
                            "stands still"));
    EXPECT_THAT(read(path, at_frame(0)).warnings,
                ElementsAre("frame 0 is beyond the animation, which has frames 1 to 3 at 24 per second: its start "
                            "stands still"));
}

TEST_F(MeshFiles, AnAlembicMeshThatStandsStillSaysSoOfAFrame)
{
    const std::string path = mesh_file(folder / "a.abc", { quad() });
    EXPECT_TRUE(read(path).warnings.empty());
    const Mesh mesh = read(path, at_frame(7));
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_THAT(mesh.warnings, ElementsAre("frame 7: nothing is animated"));
    const Mesh other = read(mesh_file(folder / "b.abc", { quad(), quad(), quad() }), at_frame(2));
    EXPECT_THAT(other.warnings, ElementsAre("frame 2: nothing is animated"));
}

TEST_F(MeshFiles, AnAlembicMeshWhoseFacesChangeIsItsEarlierSample)
{
    Polygons triangle = moved(quad(), V3f(0, 0, 8));
    triangle.corners = { 2, 1, 0 };
    triangle.counts = { 3 };
    Polygons none;
    const std::string path = mesh_file(folder / "a.abc", { quad(), triangle, none });
    EXPECT_EQ(area_vector(read(path, at_frame(1))), V3d(0, 0, 6));
    EXPECT_EQ(area_vector(read(path, at_frame(1.9))), V3d(0, 0, 6));
    EXPECT_EQ(read(path, at_frame(1.9)).positions[0].z, 0);
    EXPECT_EQ(area_vector(read(path, at_frame(2))), V3d(0, 0, 3));
    EXPECT_EQ(read(path, at_frame(2)).positions[0].z, 8);
    Mesh mesh;
    std::string error;
    EXPECT_FALSE(read_mesh(mesh, path, at_frame(3), error));
    EXPECT_EQ(error, "\"" + path + "\": no triangles");
}

TEST_F(MeshFiles, AlembicNormalsBetweenSamplesAreBetween)
{
    Polygons first = quad(), second = moved(quad(), V3f(1, 0, 0));
    const std::vector<V3f> up(4, V3f(0, 1, 0)), front(4, V3f(0, 0, 1));
    first.normals = { Abc::N3fArraySample(up), Abc::kFacevaryingScope };
    second.normals = { Abc::N3fArraySample(front), Abc::kFacevaryingScope };
    const Mesh mesh = read(mesh_file(folder / "a.abc", { first, second }), at_frame(1.5));
    for (const V3f& normal : mesh.normals)
        EXPECT_LT((normal - V3f(0, 1, 1).normalized()).length(), 1e-6f);
}

TEST_F(MeshFiles, AlembicTransformsBetweenSamplesTurnAndGrow)
{
    const auto turned = [](double degrees, double scale) {
        Abc::XformSample sample;
        sample.setTranslation(V3d(degrees, 0, 0));
        sample.setRotation(V3d(0, 0, 1), degrees);
        sample.setScale(V3d(scale));
        return sample;
    };
    // The same as a matrix, which cannot tell a full turn.
    const auto matrix = [&](double degrees, double scale) {
        Abc::XformSample sample;
        sample.setMatrix(turned(degrees, scale).getMatrix());
        return sample;
    };
    const auto mesh_at = [&](const std::vector<Abc::XformSample>& samples, double frame) {
        const std::string path = folder / "a.abc";
        {
            Archive archive(path);
            Archive::add_mesh(Archive::add_xform(archive.top(), "x", samples), "leaf", { quad() });
        }
        return read(path, at_frame(frame));
    };
    const auto has = [](const Mesh& mesh, const V3d& point) {
        return std::any_of(mesh.positions.begin(), mesh.positions.end(),
                           [&](const V3d& p) { return (p - point).length() < 1e-5; });
    };
    // Half of a full turn at twice the size: (2, 0, 0) goes to (-4, 0, 0), and on by 180.
    EXPECT_TRUE(has(mesh_at({ turned(0, 1), turned(360, 3) }, 1.5), V3d(176, 0, 0)));
    // Half of a quarter turn at twice the size, by numbers and by matrices.
    const V3d expected(45 + 4 * std::sqrt(0.5), 4 * std::sqrt(0.5), 0);
    EXPECT_TRUE(has(mesh_at({ turned(0, 1), turned(90, 3) }, 1.5), expected));
    EXPECT_TRUE(has(mesh_at({ matrix(0, 1), matrix(90, 3) }, 1.5), expected));
    EXPECT_TRUE(has(mesh_at({ matrix(0, 1), matrix(90, 3) }, 2), V3d(90, 6, 0)));
}

TEST_F(MeshFiles, AlembicVisibilityIsThatOfTheFrame)
{
    const std::string path = folder / "a.abc";
    {
        Archive archive(path);
        Abc::OPolyMesh mesh = Archive::add_mesh(archive.top(), "blinks", { quad() });
        Abc::OVisibilityProperty visible
            = Abc::CreateVisibilityProperty(mesh, Abc::TimeSamplingPtr(new Abc::TimeSampling(kFilm)));
        visible.set(int8_t(Abc::kVisibilityHidden));
        visible.set(int8_t(Abc::kVisibilityVisible));
    }
    EXPECT_EQ(refusal(path), "no triangles");
    EXPECT_EQ(read(path, at_frame(2)).triangles.size(), 2u);
}
