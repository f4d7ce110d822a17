// SPDX-License-Identifier: Apache-2.0
// Quads are cut along one diagonal, however they bend: the poses of a mesh have the same triangles.
#include "mesh_fixture.h"

#include <vmlight/mesh/import/polygons.h>
#include <vmlight/mesh/same_triangles.h>

#include <OpenImageIO/strutil.h>

#include <array>
#include <random>

using namespace mesh_files;

namespace {

using QuadCorners = std::array<V3d, 4>;

const QuadCorners kUnitSquare { V3d(0, 0, 0), V3d(1, 0, 0), V3d(1, 1, 0), V3d(0, 1, 0) };

QuadCorners scaled(QuadCorners quad, double scale)
{
    for (V3d& corner : quad)
        corner *= scale;
    return quad;
}

// The square with corner k at `at`.
QuadCorners square_with(size_t k, const V3d& at)
{
    QuadCorners quad = kUnitSquare;
    quad[k] = at;
    return quad;
}

// As the one face of a file with texture coordinates of its own for each corner.
std::string obj_of(const QuadCorners& quad)
{
    std::string text;
    for (const V3d& p : quad)
        text += OIIO::Strutil::fmt::format("v {} {} {}\nvt {} {}\n", p.x, p.y, p.z, &p - &quad[0], (&p - &quad[0]) / 2);
    return text + "f 1/1 2/2 3/3 4/4\n";
}

std::string collada_of(const QuadCorners& quad)
{
    std::string numbers;
    for (const V3d& p : quad)
        numbers += OIIO::Strutil::fmt::format("{} {} {} ", p.x, p.y, p.z);
    return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="12">)"
        + numbers + R"(</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<source id="t"><float_array id="ta" count="8">0 0 1 0 2 1 3 1</float_array>
<technique_common><accessor source="#ta" count="4" stride="2"><param name="S" type="float"/>
<param name="T" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><input semantic="TEXCOORD" source="#t" offset="0"/>
<vcount>4</vcount><p>0 1 2 3</p></polylist></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

} // namespace

TEST(Quads, AreCutInsideThemselves)
{
    const V3d inside[] { V3d(0.6, 0.6, 0), V3d(0.4, 0.6, 0), V3d(0.4, 0.4, 0), V3d(0.6, 0.4, 0) };
    for (const double size : { 1.0, 1e-150, 1e150, 0x1p-1000 }) {
        EXPECT_EQ(quad_diagonal(scaled(kUnitSquare, size)), 0) << size;
        for (size_t k = 0; k < 4; ++k) // the diagonal goes through the concave corner
            EXPECT_EQ(quad_diagonal(scaled(square_with(k, inside[k]), size)), int(k % 2)) << k << ' ' << size;
    }
    EXPECT_EQ(quad_diagonal(square_with(2, V3d(0))), 0); // without an area
}

TEST(Quads, AreCutAlikeHoweverTheyBend)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> bend(-0.7, 0.7);
    for (int i = 0; i < 1000; ++i) {
        QuadCorners quad = kUnitSquare;
        for (V3d& corner : quad)
            corner.z += bend(random);
        EXPECT_EQ(quad_diagonal(quad), 0) << i;
    }
}

TEST_F(MeshFiles, PosesOfAQuadHaveTheSameTriangles)
{
    const QuadCorners bent = square_with(2, V3d(0.8, 0.8, 0.9)), folded = square_with(1, V3d(0.4, 0.6, 0));
    for (const bool is_collada : { false, true }) {
        const char* const name = is_collada ? "quad.dae" : "quad.obj";
        const auto file = is_collada ? collada_of : obj_of;
        const Mesh mesh = read(name, file(kUnitSquare)), pose = read(name, file(bent)),
                   other = read(name, file(folded));
        ASSERT_EQ(mesh.triangles.size(), 2u);
        ASSERT_EQ(mesh.uvs.size(), 4u);
        EXPECT_EQ(triangles_fault(mesh, pose), "") << name;
        EXPECT_NE(triangles_fault(mesh, other), "") << name;
        EXPECT_NEAR(area(other), 0.4, 1e-6) << name; // inside itself
    }
}
