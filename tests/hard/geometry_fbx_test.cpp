// SPDX-License-Identifier: Apache-2.0
// FBX files whose Models are connected as no tree is.
#include "damage.h"
#include "fbx_files.h"
#include "hard_case.h"
#include "temporary_folder.h"

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/mesh/mesh.h>

using namespace vmlight;

namespace {

const int kForms[] = { 0, 7400, 7500 }; // text, and versions of binary
const int64_t kTriangle = 1000000;

struct Connection
{
    int64_t child, parent;
    std::string type = "OO";
};

FbxRecord object(const std::string& kind, int64_t id, const std::string& name, const std::string& type, int version,
                 std::vector<FbxRecord> records = {})
{
    const std::string full = version == 0 ? kind + "::" + name : name + std::string("\0\1", 2) + kind;
    records.push_back({ "Version", { 232 }, {} });
    return { kind, { id, full, type }, records };
}

// A triangle, which is kTriangle to connect, and Models 1 to `models`, A, B and so on.
std::string fbx(int64_t models, const std::vector<Connection>& connections, int version,
                const std::vector<FbxRecord>& more = {})
{
    FbxRecord objects { "Objects", {}, more }, connected { "Connections", {}, {} };
    for (int64_t id = 1; id <= models; ++id)
        objects.records.push_back(object("Model", id, std::string(1, char('A' + (id - 1) % 26)), "Mesh", version));
    objects.records.push_back(object("Geometry", kTriangle, "", "Mesh", version,
                                     { { "Vertices", { std::vector<double> { 0, 0, 0, 1, 0, 0, 0, 1, 0 } }, {} },
                                       { "PolygonVertexIndex", { std::vector<int32_t> { 0, 1, -3 } }, {} } }));
    for (const Connection& c : connections) {
        FbxRecord& record = connected.records.emplace_back();
        record.name = "C";
        record.properties = { c.type, c.child, c.parent };
        if (c.type == "OP")
            record.properties.emplace_back(std::string());
    }
    return fbx_of({ { "FBXHeaderExtension", {}, { { "FBXVersion", { version == 0 ? 7400 : version }, {} } } },
                    objects,
                    connected },
                  version);
}

// "1 triangle", or what is said, less the path.
std::string outcome(const TemporaryFolder& folder, const std::string& bytes, const char* name = "a.fbx")
{
    const std::string path = folder.write(name, bytes);
    Mesh mesh;
    std::string error;
    if (read_mesh(mesh, path, {}, error))
        return format("{} triangle{}", mesh.triangles.size(), mesh.triangles.size() == 1 ? "" : "s");
    EXPECT_EQ(error.find("\"" + path + "\": "), 0u) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error.substr(std::min(error.size(), path.size() + 4));
}

// Models 1 to `count`, each `times` under the one before; the last has the triangle.
std::vector<Connection> chain(int64_t count, int times)
{
    std::vector<Connection> connections { { 1, 0 }, { kTriangle, count } };
    for (int64_t id = 2; id <= count; ++id)
        connections.insert(connections.end(), size_t(times), { id, id - 1 });
    return connections;
}

} // namespace

TEST(Geometry, FbxModelsInARing)
{
    HardCase row("An FBX, text or binary, with a cycle of Models, whatever the file is called");
    row.naive("assimp 5.2 recurses endlessly: a crash (measured)");
    const TemporaryFolder folder;
    const std::string says = "node \"A\" is its own ancestor";
    for (const int version : kForms) {
        const std::string ring = fbx(2, { { 1, 0 }, { 2, 1 }, { 1, 2 } }, version);
        for (const char* name : { "a.fbx", "a.FBX", "a.gltf", "a" })
            EXPECT_EQ(outcome(folder, ring, name), says) << version << ", " << name;
        EXPECT_EQ(outcome(folder, fbx(1, { { 1, 0 }, { 1, 1 } }, version)), says) << version;
        for (const char* type : { "OP", "any" })
            EXPECT_EQ(outcome(folder, fbx(2, { { 1, 0 }, { 2, 1 }, { 1, 2, type } }, version)), says) << type;
        EXPECT_EQ(outcome(folder, fbx(3, { { 1, 0 }, { kTriangle, 1 }, { 3, 2 }, { 2, 3 } }, version)), "1 triangle")
            << "a ring that is not under the root, " << version;
        EXPECT_EQ(outcome(folder, fbx(2, { { 1, 0 }, { kTriangle, 1 }, { 2, 1 }, { 1, 2, "PP" } }, version)),
                  "1 triangle")
            << version;
    }
    std::string text = fbx(2, { { 1, 0 }, { kTriangle, 2 }, { 2, 1 }, { 1, 2 } }, 0);
    const size_t closes = text.rfind("C:");
    EXPECT_EQ(outcome(folder, text.substr(0, closes) + ";} : \"\f" + text.substr(closes)), says) << "a comment ended";
    EXPECT_EQ(outcome(folder, text.substr(0, closes) + "X: \"}{;\", 1\n" + text.substr(closes)), says) << "a string";
    EXPECT_EQ(outcome(folder, text.insert(closes, ";")), "1 triangle") << "a connection in a comment";
    row.ours("refused, naming a Model of the cycle");
}

TEST(Geometry, FbxModelsUnderTwoOthers)
{
    HardCase row("An FBX of 40 Models, each connected twice to its parent");
    EXPECT_GT(std::ldexp(1.0, 39), 5e11);
    row.naive("assimp 5.2 duplicates each: out of memory (measured with 8 GB)");
    const TemporaryFolder folder;
    for (const int version : kForms) {
        EXPECT_EQ(outcome(folder, fbx(5, chain(5, 2), version)), "16 triangles") << version;
        EXPECT_EQ(outcome(folder, fbx(40, chain(40, 2), version)), "node instances expand to more than 50080 nodes")
            << version;
    }
    row.ours("5 Models give 16 triangles; 40 are refused, with the reason");
}

TEST(Geometry, FbxThatIsDeep)
{
    HardCase row("An FBX of 50000 nested Models, or of two million brackets");
    row.naive("assimp 5.2 recurses, a dozen nodes for a Model with pivots: a crash (both measured)");
    const TemporaryFolder folder;
    for (const int version : kForms) {
        EXPECT_EQ(outcome(folder, fbx(50000, chain(50000, 1), version)), "nodes are nested more than 5000 deep")
            << version;
        EXPECT_EQ(outcome(folder, fbx(4000, chain(4000, 1), version)), "1 triangle") << version;
        FbxRecord nested { "Nested", {}, {} };
        for (int depth = 1; depth < 1002; ++depth)
            nested = FbxRecord { "Nested", {}, { nested } };
        EXPECT_EQ(outcome(folder, fbx_of({ nested }, version)), "brackets are nested more than 1000 deep") << version;
    }
    EXPECT_EQ(outcome(folder, OIIO::Strutil::repeat("a:{", 2000000)), "brackets are nested more than 1000 deep");
    row.ours("refused beyond 5000 Models or 1000 brackets");
}

TEST(Geometry, FbxMeshUnderTheBoneThatBendsIt)
{
    HardCase row("An FBX whose mesh is a child of the bone that deforms it: a cycle of connections, but not of Models");
    row.naive("a check for cycles in all connections refuses it");
    const TemporaryFolder folder;
    const std::vector<double> unit { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
    const int64_t mesh = 1, bone = 2, skin = 11, cluster = 12;
    for (const int version : kForms) {
        const std::vector<FbxRecord> deformers {
            object("Deformer", skin, "", "Skin", version),
            object("Deformer", cluster, "", "Cluster", version,
                   { { "Indexes", { std::vector<int32_t> { 0, 1, 2 } }, {} },
                     { "Weights", { std::vector<double> { 1, 1, 1 } }, {} },
                     { "Transform", { unit }, {} },
                     { "TransformLink", { unit }, {} } }),
        };
        EXPECT_EQ(outcome(folder,
                          fbx(2,
                              { { bone, 0 },
                                { mesh, bone },
                                { kTriangle, mesh },
                                { skin, kTriangle },
                                { cluster, skin },
                                { bone, cluster } },
                              version, deformers)),
                  "1 triangle")
            << version;
    }
    row.ours("its triangle");
}

TEST(Geometry, FbxCutOrDamaged)
{
    HardCase row(
        "An FBX, text or binary, truncated at every seventh byte, with one bit flipped, or with lengths past its end");
    row.naive("trusting the lengths reads out of bounds");
    const TemporaryFolder folder;
    for (const int version : kForms) {
        const std::string whole = fbx(3, chain(3, 1), version);
        std::vector<Damage> damages = damages_of(whole);
        for (size_t bytes = 0; bytes < whole.size(); bytes += 7)
            damages.push_back({ "cut at " + std::to_string(bytes), whole.substr(0, bytes) });
        survive(damages, [&](const Damage& damage) { return outcome(folder, damage.bytes) == "" ? "silent" : ""; });
    }
    for (const auto& [version, zeros] : { std::pair(7400, 13), { 7500, 25 } }) { // assimp puts one zero behind a file
        const std::string whole = fbx(1, chain(1, 1), version);
        EXPECT_EQ(outcome(folder, whole.substr(0, whole.size() - size_t(zeros) - 1)), "1 triangle") << version;
    }
    // Of the first record, at byte 27: its end, before it and beyond the file; the length of its properties.
    std::string bytes = fbx(1, chain(1, 1), 7500);
    ASSERT_EQ(outcome(folder, bytes), "1 triangle");
    for (const auto& [at, number] : { std::pair<size_t, uint64_t>(27, 1),
                                      { 27, ~0ull },
                                      { 27, bytes.size() + 2 },
                                      { 43, ~0ull },
                                      { 43, ~0ull - 40 },
                                      { 43, 1u << 20 } })
        EXPECT_EQ(outcome(folder, std::string(bytes).replace(at, 8, little_endian(number))),
                  "record at byte 27 extends past the record that contains it")
            << number << " at " << at;
    row.ours("its triangle, or refused");
}
