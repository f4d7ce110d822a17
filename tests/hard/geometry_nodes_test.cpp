// SPDX-License-Identifier: Apache-2.0
// Mesh files whose nodes are many, deep, or under each other.
#include "hard_case.h"
#include "mesh_refusal.h"

#include <OpenImageIO/strutil.h>
#include <vmlight/base/format.h>
#include <vmlight/mesh/import/format_checks.h>
#include <vmlight/mesh/import/read_mesh.h>

#include <cmath>
#include <functional>

using namespace vmlight;

namespace {

// How many come of a glTF with these nodes, of which the first is in the scene, and of a mesh of one triangle.
size_t triangles_of_gltf(const TemporaryFolder& folder, const std::string& nodes)
{
    const float numbers[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
    folder.write("a.bin", std::string(reinterpret_cast<const char*>(numbers), sizeof(numbers)));
    const std::string path = folder.write(
        "a.gltf",
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes + "],"
            + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"byteLength":36,"uri":"a.bin"}],)"
            + R"("bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,)"
            + R"("count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]})");
    Mesh mesh;
    std::string error;
    EXPECT_TRUE(read_mesh(mesh, path, {}, error)) << error;
    return mesh.triangles.size();
}

} // namespace

TEST(Geometry, ATreeOfAHundredThousandNodes)
{
    HardCase row("A glTF with one triangle under 100000 nested nodes");
    row.naive("a reader that recurses overflows its stack");
    const TemporaryFolder folder;
    const int count = 100000;
    std::string nodes;
    for (int i = 1; i < count; ++i)
        nodes += format("{{\"children\":[{}]}},", i);
    EXPECT_EQ(triangles_of_gltf(folder, nodes + R"({"mesh":0})"), 1u);
    row.ours("its triangle");
}

namespace {

// ",<first>,...,<last>"
std::string numbers(int first, int last)
{
    std::string text;
    for (int i = first; i <= last; ++i)
        text += format(",{}", i);
    return text;
}

} // namespace

TEST(Geometry, NodesUnderTwoOthers)
{
    HardCase row("A glTF of 40 nodes, each listing the next twice as a child; or with a cycle of nodes");
    EXPECT_GT(std::ldexp(1.0, 40), 1e12);
    row.naive("a reader that copies a node for each parent runs out of memory");
    const TemporaryFolder folder;
    std::string twice;
    for (int i = 1; i < 40; ++i)
        twice += format("{{\"children\":[{0},{0}]}},", i);
    const auto gltf = [](const std::string& nodes, const std::string& roots = "0") {
        return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes
            + "]}";
    };
    EXPECT_EQ(refusal(folder, "a.gltf", gltf(twice + "{}")), "node 1 has two parents: 0 and 0");
    EXPECT_EQ(refusal(folder, "a.gltf", gltf(R"({"children":[2]},{"children":[2]},{})")),
              "node 2 has two parents: 0 and 1");
    EXPECT_EQ(refusal(folder, "a.gltf", gltf(R"({"children":[1]},{"children":[0]})")), "node 0 is its own ancestor");
    EXPECT_EQ(refusal(folder, "a.gltf",
                      gltf(R"({"children":[1)" + numbers(2, 1200) + "]}" + OIIO::Strutil::repeat(",{}", 1200),
                           "0" + OIIO::Strutil::repeat(",0", 1000))),
              "node instances expand to more than 1000000 nodes");
    EXPECT_EQ(refusal(folder, "a.gltf", std::string(1001, '[')), "JSON is nested more than 1000 deep");
    row.ours("refused, naming the node");
}

TEST(Geometry, AGltfOfAMillionNodes)
{
    HardCase row("A glTF of a million nodes, only one of them in the scene");
    row.naive("nlohmann-json with a filtering callback takes quadratic time: 1 s for 100000 (measured)");
    const TemporaryFolder folder;
    EXPECT_EQ(triangles_of_gltf(folder, R"({"mesh":0})" + OIIO::Strutil::repeat(",{}", 999999)), 1u);
    row.ours("its triangle");
}

namespace {

// A triangle under the last of `count` nodes, each of which but the last holds `inner` of the next.
std::string collada(int count, const std::function<std::string(int next)>& inner)
{
    std::string nodes;
    for (int i = 0; i + 1 < count; ++i)
        nodes += format(R"(<node id="n{}">{}</node>)", i, inner(i + 1));
    return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">)"
           R"(<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">)"
           R"(0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#pa" count="3" stride="3">)"
           R"(<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>)"
           R"(</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>)"
           R"(<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh>)"
           R"(</geometry></library_geometries><library_nodes>)"
        + nodes + format(R"(<node id="n{}"><instance_geometry url="#g"/></node>)", count - 1)
        + R"(</library_nodes><library_visual_scenes><visual_scene id="s"><node><instance_node url="#n0"/></node>)"
          R"(</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

std::string named(int next)
{
    return format(R"(<instance_node url="#n{}"/>)", next);
}

} // namespace

TEST(Geometry, ColladaNodesThatNameOthers)
{
    HardCase row("A Collada file whose nodes instance others, by id or by name, each twice");
    EXPECT_GT(std::ldexp(1.0, 40), 1e12);
    row.naive("assimp 5.2 expands them all: 40 such nodes do not fit in memory");
    const TemporaryFolder folder;
    const auto twice = [](int next) { return named(next) + named(next); };
    const auto triangles = [&](const std::string& text, const char* name = "a.dae") {
        Mesh mesh;
        std::string error;
        EXPECT_TRUE(read_mesh(mesh, folder.write(name, text), {}, error)) << error;
        return mesh.triangles.size();
    };
    for (const char* name : { "a.dae", "a.xml", "noname" }) // assimp looks into the file
        EXPECT_EQ(triangles(collada(5, twice), name), 16u);
    EXPECT_EQ(triangles(collada(2000, named)), 1u);
    // The scene, its node, and 1 + 2 + 4 + 8 + 16 copies.
    EXPECT_EQ(inspect_collada(collada(5, twice), { 33, 100 }).error, "");
    EXPECT_EQ(inspect_collada(collada(5, twice), { 32, 100 }).error, "node instances expand to more than 32 nodes");
    EXPECT_EQ(inspect_collada(collada(20, named), { 100, 12 }).error, "nodes are nested more than 12 deep");
    EXPECT_EQ(inspect_collada("<COLLADA>" + OIIO::Strutil::repeat("<node>", 50), { 100, 50 }).error,
              "XML elements are nested more than 50 deep");
    row.ours("16 triangles of five; refused before assimp reads them, with the reason, beyond a million nodes or "
             "100000 deep");
}

TEST(Geometry, ColladaNamesAreFoundAsAssimpFindsThem)
{
    HardCase row("A Collada instance_node that names a node outside the library, by id or name, or one of both places");
    row.naive("a check that finds another node than assimp counts other copies");
    // Beside what is instanced, the scene has a node with the attributes `named` that holds one of the library's.
    const auto nodes = [](const char* attributes, const char* url) {
        const std::string text = OIIO::Strutil::replace(
            collada(1, named), "<node><instance_node url=\"#n0\"/>",
            format("<node {}><node/><node/></node><node><instance_node url=\"{}\"/>", attributes, url));
        size_t count = 1;
        while (!inspect_collada(text, { count, 100 }).error.empty())
            ++count;
        return count;
    };
    const size_t alone = 5; // the scene, the node with two, the node that instances nothing
    EXPECT_EQ(nodes("id=\"a\"", "#missing"), alone);
    EXPECT_EQ(nodes("id=\"a\"", "#n0"), alone + 1);
    EXPECT_EQ(nodes("id=\"a\"", "#a"), alone + 3);
    EXPECT_EQ(nodes("name=\"a\"", "#a"), alone + 3);
    EXPECT_EQ(nodes("id=\"n0\"", "#n0"), alone + 1) << "the library comes first";
    EXPECT_EQ(nodes("", "a"), alone);
    row.ours("the same node, and so the same count");
}

TEST(Geometry, FormatsThatNobodyLooksAt)
{
    HardCase row("An X3D, also under the name of an STL; a glTF 1.0; a zip archive");
    row.naive("assimp 5.2 reads what it takes the content for; some formats crash it (measured)");
    const TemporaryFolder folder;
    const std::string none
        = "unknown mesh format; supported: OBJ, PLY, STL, glTF 2.0, Collada, FBX, Alembic, height image, scene list";
    const std::string x3d
        = "<?xml version=\"1.0\"?><X3D version=\"3.0\"><Scene><Shape><IndexedTriangleSet index=\"0 1 2\">"
          "<Coordinate point=\"0 0 0 1 0 0 0 1 0\"/></IndexedTriangleSet></Shape></Scene></X3D>";
    EXPECT_EQ(refusal(folder, "a.x3d", x3d), none);
    EXPECT_NE(refusal(folder, "a.stl", x3d), "") << "no other importer than that of STL takes it";
    EXPECT_EQ(refusal(folder, "a.gltf",
                      R"({"asset":{"version":"1.0"},"scene":"s","scenes":{"s":{"nodes":["a"]}},)"
                      R"("nodes":{"a":{}}})"),
              "glTF version 1.0; supported: 2.0");
    EXPECT_EQ(refusal(folder, "a.3mf", "PK\3\4"), "a zip archive: unpack it, and pass the mesh inside");
    row.ours("refused; README lists the formats that are read");
}
