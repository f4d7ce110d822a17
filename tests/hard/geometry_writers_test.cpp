// SPDX-License-Identifier: Apache-2.0
// OBJ and PLY files as programs write them, beyond what readers expect.
#include "hard_case.h"
#include "judgement.h"
#include "mesh_files.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/read_mesh.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>

using namespace vmlight;
using namespace vmlight::scenes;
using OIIO::Strutil::replace;

namespace {

Mesh read(const std::string& path)
{
    Mesh mesh;
    std::string error;
    EXPECT_TRUE(read_mesh(mesh, path, {}, error)) << error;
    return mesh;
}

// An OBJ without normals, and with `line_of(t)` before triangle t.
template <class LineOf> std::string without_normals(const Mesh& mesh, const LineOf& line_of)
{
    std::string text;
    for (const V3d& p : mesh.positions)
        text += format("v {} {} {}\n", p.x, p.y, p.z);
    for (const V2f& uv : mesh.uvs)
        text += format("vt {} {}\n", uv.x, uv.y);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& c = mesh.triangles[t];
        text += line_of(t) + format("f {0}/{0} {1}/{1} {2}/{2}\n", c[0] + 1, c[1] + 1, c[2] + 1);
    }
    return text;
}

} // namespace

TEST(Geometry, ObjOfHardEdgesWithoutNormals)
{
    HardCase row("A box in an OBJ without normals: `s off`, or a smoothing group for each side",
                 "assimp, tinyobjloader's callbacks: no smoothing groups");
    const TemporaryFolder folder;
    const Mesh truth = box(V3d(-1), V3d(1), false);
    const auto none = [](size_t) { return std::string(); };
    const auto off = [](size_t t) { return std::string(t == 0 ? "s off\n" : ""); };
    const auto sides = [](size_t t) { return format("s {}\n", t / 2 + 1); };
    const Mesh smooth = read(folder.write("a.obj", without_normals(truth, none)));
    for (const auto& t : smooth.triangles)
        for (const uint32_t vertex : t)
            EXPECT_NEAR(V3d(smooth.normals[vertex]).dot(triangle_area_normal(smooth, t).normalized()),
                        std::sqrt(1.0 / 3), 1e-6);
    row.naive("smooth across the edges: normals and B lean by up to 55 degrees");
    for (const std::string& text : { without_normals(truth, off), without_normals(truth, sides) }) {
        const Mesh mesh = read(folder.write("b.obj", text));
        EXPECT_EQ(texels_that_see_less_than_all(mesh, 64, 64), 0);
        for (const auto& t : mesh.triangles)
            for (const uint32_t vertex : t)
                EXPECT_EQ(mesh.normals[vertex], V3f(triangle_area_normal(mesh, t).normalized()));
    }
    row.ours("flat: each side has its own normal, and V = 1 exactly");
}

TEST(Geometry, ObjStatementsOfOtherWriters)
{
    HardCase row("An OBJ with `.5` for 0.5, four to eight numbers a vertex, comments behind statements, `vp`, curves, "
                 "continued lines",
                 "assimp 5.2 skips such vertices, so that all indices behind them shift (measured)");
    const TemporaryFolder folder;
    const std::string plain = "v 0 0 0\nv 1 0 0\nv 0.5 1 0\nv -0.5 0.5 0.25\nvt 0 0\nvt 0.5 0.25\nvn 0 0 1\n"
                              "f 1/1/1 2/2/1 3/1/1\nf 1/1/1 3/2/1 4/2/1\n";
    const std::string hash = mesh_hash(read(folder.write("plain.obj", plain)));
    const std::pair<const char*, const char*> changes[] = {
        { "0.", "." },
        { "v -0.5", "v -.5" },
        { "v 1 0 0", "v +1 0e0 0." },
        { "v 1 0 0", "v 1 0 0 1" },
        { "v 1 0 0", "v 1 0 0 .5" },
        { "v 1 0 0", "v 1 0 0 .1 .2" },
        { "v 1 0 0", "v 1 0 0 1 1 1" },
        { "v 1 0 0", "v 1 0 0 1 1 1 1 1" },
        { "\n", " # c\n" },
        { "\n", "#c 1 2\n" },
        { " ", "\t " },
        { "f 1", "vp .1 .2\nf 1" },
        { "f 1", "cstype bezier\ncurv 0 1 1 2\nend\nl 1 2\np 1\nf 1" },
        { " 3/1/1", " \\\n3/1/1" },
        { "\n", "\r" },
        { "\n", "\r\n" },
        { "v 0 0 0", "\xef\xbb\xbfv 0 0 0" },
        { "f 1/1/1 2/2/1", "f -4/-2/-1 -3/-1/-1" },
        { "vt 0 0", "vt 0" },
        { "vt 0 0", "vt 0 0 0" },
    };
    for (const auto& [what, instead] : changes) {
        const std::string text = replace(plain, what, instead, true);
        ASSERT_NE(text, plain);
        EXPECT_EQ(mesh_hash(read(folder.write("a.obj", text))), hash) << instead;
    }
    row.naive("a mesh other than the file's, or refused");
    row.ours("the same mesh, bit for bit, as without them");
}

TEST(Geometry, PlyTextureOfCorners)
{
    HardCase row("A box in a PLY of eight vertices, with texture coordinates for each corner of a face (MeshLab)",
                 "assimp 5.2: the last face wins");
    const TemporaryFolder folder;
    const Mesh truth = box(V3d(-1), V3d(1), false);
    std::string vertices, faces;
    std::vector<V3d> places;
    const auto number_of = [&](const V3d& p) {
        const auto place = std::find(places.begin(), places.end(), p);
        if (place != places.end())
            return place - places.begin();
        places.push_back(p);
        vertices += format("{} {} {}\n", p.x, p.y, p.z);
        return std::ptrdiff_t(places.size() - 1);
    };
    for (const auto& t : truth.triangles) {
        faces += "3";
        for (const uint32_t vertex : t)
            faces += format(" {}", number_of(truth.positions[vertex]));
        faces += " 6";
        for (const uint32_t vertex : t)
            faces += format(" {:.9g} {:.9g}", truth.uvs[vertex].x, truth.uvs[vertex].y);
        faces += "\n";
    }
    EXPECT_EQ(places.size(), 8u);
    row.naive("one of the three texture coordinates of each corner: most of the texture is of the wrong side");
    const std::string header = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
                               "property float z\nelement face 12\nproperty list uchar int vertex_indices\n"
                               "property list uchar float texcoord\nend_header\n";
    Mesh mesh = read(folder.write("a.ply", header + vertices + faces));
    ASSERT_EQ(mesh.triangles.size(), truth.triangles.size());
    for (size_t t = 0; t < truth.triangles.size(); ++t)
        for (size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(mesh.uvs[mesh.triangles[t][k]], truth.uvs[truth.triangles[t][k]]);
            EXPECT_EQ(mesh.positions[mesh.triangles[t][k]], truth.positions[truth.triangles[t][k]]);
        }
    make_flat_normals(mesh);
    EXPECT_EQ(texels_that_see_less_than_all(mesh, 64, 64), 0);
    row.ours("vertices are split: each side has its own part of the texture");
}
