// SPDX-License-Identifier: Apache-2.0
// OBJ files as their writers mean them: statements, numbers, indices. Smoothing groups, objects, groups and materials:
// obj_groups_test.cpp.
#include "mesh_fixture.h"

#include <vmlight/mesh/import/text_number.h>

#include <OpenImageIO/strutil.h>

#include <cmath>
#include <limits>

using namespace mesh_files;
using OIIO::Strutil::replace;

namespace {

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

class ObjFiles : public MeshFiles
{
protected:
    // What is said of a triangle with these lines behind its vertices.
    std::string said(const std::string& lines) { return refusal(folder.write("a.obj", kTriangle + lines)); }
    // The positions of the first triangle.
    std::vector<V3d> corners(const std::string& text)
    {
        const Mesh mesh = read("a.obj", text);
        std::vector<V3d> positions;
        for (const uint32_t vertex : mesh.triangles.at(0))
            positions.push_back(mesh.positions[vertex]);
        return positions;
    }
};

} // namespace

TEST(TextNumbers, AreReadInEveryForm)
{
    const std::pair<const char*, double> forms[] = { { "1", 1 },
                                                     { "+1", 1 },
                                                     { "-1", -1 },
                                                     { ".5", 0.5 },
                                                     { "-.5", -0.5 },
                                                     { "+.5", 0.5 },
                                                     { "5.", 5 },
                                                     { "1e-3", 1e-3 },
                                                     { "-1.25E+2", -125 },
                                                     { "1.e2", 100 },
                                                     { ".25e1", 2.5 },
                                                     { "0", 0 },
                                                     { "1,5", 1.5 },
                                                     { "1e30", 1e30 },
                                                     { "123456789.125", 123456789.125 },
                                                     { "100000000000000000000", 1e20 },
                                                     { "1e-400", 0 },
                                                     { "0e99", 0 },
                                                     { ".0001e40", 1e36 } };
    for (const auto& [word, value] : forms) {
        vmlight::TextNumber number;
        EXPECT_TRUE(vmlight::parse_number(word, number)) << word;
        EXPECT_EQ(number.value, value) << word;
        EXPECT_NEAR(number.rounded, float(value), std::abs(value) * 2e-7) << word;
    }
    for (const char* word : { "nan", "-nan(ind)", "NaN", "1.#QNAN", "-1.#IND0", "1.#SNAN" }) {
        vmlight::TextNumber number;
        EXPECT_TRUE(vmlight::parse_number(word, number)) << word;
        EXPECT_TRUE(std::isnan(number.value) && std::isnan(number.rounded)) << word;
    }
    for (const char* word : { "inf", "1e999", "Infinity", "1.#INF" }) {
        vmlight::TextNumber number;
        EXPECT_TRUE(vmlight::parse_number(word, number)) << word;
        EXPECT_EQ(number.value, std::numeric_limits<double>::infinity()) << word;
        EXPECT_EQ(number.rounded, std::numeric_limits<float>::infinity()) << word;
    }
    vmlight::TextNumber beyond_float;
    EXPECT_TRUE(vmlight::parse_number("-1e39", beyond_float));
    EXPECT_EQ(beyond_float.value, -1e39);
    EXPECT_EQ(beyond_float.rounded, -std::numeric_limits<float>::infinity());
    for (const char* word : { "", "-", "+", ".", "e5", "1.5x", "1..5", "--1", "+-1", "0x10", "1/2", "1,2,3", "one" }) {
        vmlight::TextNumber number;
        EXPECT_FALSE(vmlight::parse_number(word, number)) << word;
    }
}

TEST(TextNumbers, KeepTheRoundingOfEarlierVersions)
{
    // 1.19629 and its halves: 1 + float(.19629) is the float next to the nearest. Maps of a mesh must not change.
    size_t different = 0;
    for (int i = 0; i < 100000; ++i) {
        char word[20];
        std::snprintf(word, sizeof(word), "%d.%05d", i % 7, i);
        vmlight::TextNumber number;
        ASSERT_TRUE(vmlight::parse_number(word, number));
        ASSERT_EQ(number.rounded, float(i % 7) + float(double(i) * 1e-5)) << word;
        different += number.rounded != float(number.value);
    }
    EXPECT_GT(different, 100u);
}

TEST_F(ObjFiles, NumbersNeedNoDigitBeforeThePoint)
{
    const std::vector<V3d> truth = corners("v 0 0 0.5\nv 1 0 -0.5\nv 0 0.001 0\nf 1 2 3\n");
    EXPECT_EQ(truth[2].y, double(0.001f));
    EXPECT_EQ(corners("v 0 0 .5\nv +1 0 -.5\nv 0 1e-3 0\nf 1 2 3\n"), truth);
    EXPECT_EQ(corners("v .0 -.0 +.5\nv 1. 0 -5e-1\nv 0 .1E-2 0.\nf 1 2 3\n")[1], truth[1]);
    EXPECT_EQ(read("a.obj", kTriangle + "vt .25 -.5\nvn .0 .0 .5\nf 1/1/1 2/1/1 3/1/1\n").uvs[0], V2f(0.25f, -0.5f));
}

TEST_F(ObjFiles, NoVertexIsSkipped)
{
    // One vertex of each kind before the triangle: were one skipped, all indices behind it would shift.
    for (const char* vertex :
         { "v 7 7 7 1",         "v 7 7 7 0",     "v 7 7 7 .5",   "v 7 7 7 1 0", "v 7 7 7 1 0 0",  "v 7 7 7 1 0 0 1",
           "v 7 7 7 1 0 0 1 1", "v 7 7 7 # off", "v 7 7 7# off", "v\t7\t7\t7",  "v  7   7\t 7  ", "v .7 .7 .7",
           "v 7 7 \\\n7",       " v 7 7 7",      "v 7 7 7 red",  "v 7 7 7 #7",  "v 7 7 7.#c",     "v 7 7 -1.#IND#c",
           "v 7,5 7 7",         "v nan 7 7",     "v 1e400 7 7" })
        EXPECT_EQ(corners(std::string(vertex) + "\n" + kTriangle + "f 2 3 4\n"),
                  (std::vector<V3d> { V3d(0), V3d(1, 0, 0), V3d(0, 1, 0) }))
            << vertex;
    for (const char* uv :
         { "vt .7", "vt 7", "vt 7 7", "vt 7 7 7", "vt 7 7 nan", "vt 7 7 7 7", "vt 7 7 # 7", "vt\t7 7" })
        EXPECT_EQ(read("a.obj", std::string(uv) + "\nvt .5 .25\n" + kTriangle + "f 1/2 2/2 3/2\n").uvs[0],
                  V2f(0.5f, 0.25f))
            << uv;
    for (const char* normal : { "vn 7 7 7 7", "vn nan 0 0", "vn -1.#IND 0 0", "vn 0 0 0 # none" })
        EXPECT_EQ(read("a.obj", std::string(normal) + "\nvn 1 0 0\n" + kTriangle + "f 1//2 2//2 3//2\n").normals[0],
                  V3f(1, 0, 0))
            << normal;
}

TEST_F(ObjFiles, AWeightIsForCurvesAndAColourForNothing)
{
    EXPECT_EQ(corners("v 2 4 8 2\nv 3 4 8 0\nv 2 5 8 -1\nf 1 2 3\n"),
              (std::vector<V3d> { V3d(2, 4, 8), V3d(3, 4, 8), V3d(2, 5, 8) }));
    EXPECT_EQ(corners("v 2 4 8 .1 .2 .3\nv 3 4 8 1 1 1 .5\nv 2 5 8\nf 1 2 3\n")[1], V3d(3, 4, 8));
    EXPECT_EQ(read("a.obj", kTriangle + "vt .5\nf 1/1 2/1 3/1\n").uvs[0], V2f(0.5f, 0));
}

TEST_F(ObjFiles, CommentsStandBehindAnyStatement)
{
    const std::string commented = replace(kQuadObj, "\n", " # c 1 2 3 \\\n", true);
    EXPECT_EQ(mesh_hash(read("a.obj", commented)), mesh_hash(read("b.obj", kQuadObj)));
    EXPECT_EQ(mesh_hash(read("a.obj", replace(kQuadObj, "\n", "#c\n", true))), mesh_hash(read("b.obj", kQuadObj)));
    EXPECT_EQ(mesh_hash(read("a.obj", "#\n # \\\n\n" + replace(kQuadObj, "\n", "\n#v 1 2 3\n", true))),
              mesh_hash(read("b.obj", kQuadObj)));
}

TEST_F(ObjFiles, WhatIsNotOfPolygonsIsSkipped)
{
    const std::string quad = kQuadObj;
    const size_t face = quad.find("f 1");
    const std::string others = "vp 0.1 0.2\nvp .5\ncstype rat bezier\ndeg 3 3\ncurv2 1 2\ncurv 0 1 1 2 3\n"
                               "parm u 0 1\ntrim 0 1 1\nend\nl 1/1 2/2\np 1 2\nbevel on\nlod 1\nmaplib a b\nusemap x\n"
                               "shadow_obj x\nunknown 1 2 3\n";
    const Mesh mesh = read("a.obj", quad.substr(0, face) + others + quad.substr(face));
    EXPECT_EQ(mesh_hash(mesh), mesh_hash(read("b.obj", quad)));
    EXPECT_TRUE(mesh.warnings.empty());
    const Mesh surface = read("a.obj", quad + "surf 0 1 0 1 1/1/1 2/2/1 3/3/1 4/4/1\nend\ncall more.obj\n");
    ASSERT_EQ(surface.warnings.size(), 1u);
    EXPECT_EQ(surface.warnings[0], "not read: statements \"surf\", \"call\"; only polygons are");
}

TEST_F(ObjFiles, CornersNameWhatTheyHave)
{
    const std::string head = kTriangle + "vt .5 .5\nvt .25 .25\nvn 0 1 0\nvn 1 0 0\n";
    const auto expect = [&](const char* face, const V2f& uv, const V3f& normal) {
        // Another face has all, so that what is missing is missing in part of the file.
        const Mesh mesh = read("a.obj", head + face + "\nf 1/2/2 2/2/2 3/2/2\n");
        for (const uint32_t vertex : mesh.triangles.at(0)) {
            EXPECT_EQ(std::isnan(mesh.uvs[vertex].x), std::isnan(uv.x)) << face;
            EXPECT_TRUE(std::isnan(uv.x) || mesh.uvs[vertex] == uv) << face;
            EXPECT_EQ(mesh.normals[vertex], normal) << face;
        }
    };
    const V2f half(0.5f, 0.5f), none(NAN, NAN);
    const V3f up(0, 1, 0), made(0, 0, 1);
    expect("f 1 2 3", none, made);
    expect("f 1/ 2// 3", none, made);
    expect("f 1/1 2/1 3/1", half, made);
    expect("f 1/1/ 2/1/ 3/1/", half, made);
    expect("f 1//1 2//1 3//1", none, up);
    expect("f 1/1/1 2/1/1 3/1/1", half, up);
    expect("f -3/-2/-2 -2/-2/-2 -1/-2/-2", half, up);
    expect("fo 1/1/1\t2/1/1   3/1/1", half, up);
    const Mesh mixed = read("a.obj", head + "f 1/1/1 2//1 3\n");
    EXPECT_EQ(mixed.uvs[mixed.triangles[0][0]], half);
    EXPECT_TRUE(std::isnan(mixed.uvs[mixed.triangles[0][1]].x));
    EXPECT_EQ(mixed.normals[mixed.triangles[0][1]], up);
    EXPECT_EQ(mixed.normals[mixed.triangles[0][2]], made);
}

TEST_F(ObjFiles, LinesEndInAnyWay)
{
    const Mesh quad = read("a.obj", kQuadObj);
    for (const char* end : { "\r\n", "\r", "\n\n", " \t\n", "\r\r\n" })
        EXPECT_EQ(mesh_hash(read("b.obj", replace(kQuadObj, "\n", end, true))), mesh_hash(quad));
    const std::string text = kQuadObj;
    EXPECT_EQ(mesh_hash(read("b.obj", text.substr(0, text.size() - 1))), mesh_hash(quad));
    EXPECT_EQ(mesh_hash(read("b.obj", "\xef\xbb\xbf" + text)), mesh_hash(quad));
    EXPECT_EQ(mesh_hash(read("b.obj", replace(text, "/4/1\n", "/4/1\\"))), mesh_hash(quad));
    EXPECT_EQ(mesh_hash(read("b.obj", replace(text, " 2/2/1 3/3/1", " \\\r\n\t2/2/1 \\\r\n3/3/1"))), mesh_hash(quad));
}

TEST_F(ObjFiles, AFaceMayComeBeforeItsVertices)
{
    EXPECT_EQ(corners("f 1 2 3\n" + kTriangle)[1], V3d(1, 0, 0));
    EXPECT_EQ(corners(kTriangle + "v 5 5 5\nf -4 -3 -2\nv 6 6 6\n")[2], V3d(0, 1, 0));
}

TEST_F(ObjFiles, WhatCannotBeReadIsToldByLine)
{
    const std::string head = "cannot read as OBJ: line ";
    EXPECT_EQ(said("f 1 2 99\n"), head + "4: a face uses vertex 99, but there are only 3");
    EXPECT_EQ(said("\n\nf 1 \\\n0 2\n"), head + "6: a face uses vertex 0, but they count from 1: \"f 1  0 2\"");
    EXPECT_EQ(said("f 1 2 -4\nv 0 0 0\n"),
              head + "4: a face uses vertex -4, but there are only 3 before it: \"f 1 2 -4\"");
    EXPECT_EQ(said("vt 0 0\nf 1/1 2/1 3/2\n"), head + "5: a face uses texture coordinate 2, but there are only 1");
    EXPECT_EQ(said("vn 0 0 1\nf 1//1 2//-2 3//1\n"),
              head + "5: a face uses normal -2, but there are only 1 before it: \"f 1//1 2//-2 3//1\"");
    EXPECT_EQ(said("f 1 2 99999999999999999999\n").find(head + "4: a face uses vertex "), 0u);
    for (const char* face : { "f 1 2 x", "f 1 2 3.5", "f 1 2 /3", "f 1 2 3/x", "f 1 2 3/1/x", "f 1 2 -", "f 1, 2, 3" })
        EXPECT_EQ(said(std::string(face) + "\n"),
                  head + "4 has a corner that is not one of 1, 1/1, 1//1 and 1/1/1: \"" + face + "\"");
    for (const char* vertex : { "v 1 2", "v", "v 1 2 # 3", "v 1 2 x", "v 1;2;3" })
        EXPECT_EQ(said(std::string(vertex) + "\n").find(head + "4 must have 3 numbers: "), 0u) << vertex;
    EXPECT_EQ(said("vn 1 2\n"), head + "4 must have 3 numbers: \"vn 1 2\"");
    EXPECT_EQ(said("vt x\n"), head + "4 must have 2 numbers: \"vt x\"");
    EXPECT_EQ(said("vt 0 1e999\n"), "line 4 has non-finite texture coordinates: \"vt 0 1e999\"");
}
