// SPDX-License-Identifier: Apache-2.0
// FBX files whose Models are connected as no tree is.
#include "damage.h"
#include "fbx_files.h"
#include "hard_case.h"
#include "temporary_folder.h"

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/format_checks.h>
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

TEST(Geometry, FbxModelsUnderTwoOthers)
{
    HardCase row("An FBX, text or binary, whose Models are each connected twice to their parent");
    EXPECT_GT(std::ldexp(1.0, 39), 5e11);
    row.naive("assimp 5.2 duplicates each: 40 Models do not fit in 8 GB (measured)");
    const TemporaryFolder folder;
    for (const int version : kForms) {
        for (const char* name : { "a.fbx", "a.FBX", "a.gltf", "a" })
            EXPECT_EQ(outcome(folder, fbx(5, chain(5, 2), version), name), "16 triangles") << version << ", " << name;
        // The root, and 1 + 2 + 4 + 8 + 16 copies of 5 Models, for 10 connections.
        EXPECT_EQ(inspect_fbx(fbx(5, chain(5, 2), version), { 22, 100 }).error, "") << version;
        EXPECT_EQ(inspect_fbx(fbx(5, chain(5, 2), version), { 21, 100 }).error,
                  "node instances expand to more than 31 nodes")
            << version;
        EXPECT_EQ(outcome(folder, fbx(3, { { 1, 0 }, { kTriangle, 1 }, { 3, 2 }, { 2, 3 } }, version)), "1 triangle")
            << "a ring that is not under the root, " << version;
        EXPECT_EQ(outcome(folder, fbx(2, { { 1, 0 }, { kTriangle, 1 }, { 2, 1 }, { 1, 2, "PP" } }, version)),
                  "1 triangle")
            << version;
    }
    row.ours("16 triangles of five; refused before assimp reads them beyond 50000 copies, with the reason");
}

TEST(Geometry, FbxConnectionsAreReadAsAssimpReadsThem)
{
    HardCase row("FBX connections of every type, in comments, behind strings with brackets");
    row.naive("a check that sees other connections than assimp counts other copies");
    // How many nodes Models 1 and 2 expand to, with 2 connected to 1 once and in the other way once more.
    const auto copies = [](const std::string& bytes) {
        NodeLimits limits { 0, 100 };
        std::string error;
        while (!(error = inspect_fbx(bytes, limits).error).empty() && limits.nodes < 20)
            ++limits.nodes;
        EXPECT_EQ(error, "");
        return limits.nodes; // more than the connections
    };
    for (const int version : kForms) {
        const auto of_type = [&](const char* type) {
            return copies(fbx(3, { { 1, 0 }, { 2, 1 }, { 3, 2 }, { 2, 1, type } }, version));
        };
        EXPECT_EQ(of_type("PP"), 1u) << "the root and 3 Models, of 3 connections that count";
        for (const char* type : { "OO", "OP", "any" })
            EXPECT_EQ(of_type(type), 2u) << type << ", " << version;
    }
    const std::string text = fbx(3, { { 1, 0 }, { 2, 1 }, { 3, 2 }, { 2, 1 } }, 0);
    const size_t last = text.rfind("C:");
    const auto before_the_last
        = [&](const std::string& more) { return text.substr(0, last) + more + text.substr(last); };
    EXPECT_EQ(copies(before_the_last(";} : \"\f")), 2u) << "a comment ended";
    EXPECT_EQ(copies(before_the_last("X: \"}{;\", 1\n")), 2u) << "a string";
    EXPECT_EQ(copies(before_the_last(";")), 1u) << "the root and 3 Models, of 3 connections";
    row.ours("the same connections, and so the same count");
}

TEST(Geometry, FbxThatIsDeep)
{
    HardCase row("An FBX of 4000 nested Models, or of 1002 brackets");
    row.naive("assimp 5.2 recurses, a dozen nodes for a Model with pivots: its stack ends (measured)");
    const TemporaryFolder folder;
    for (const int version : kForms) {
        EXPECT_EQ(outcome(folder, fbx(4000, chain(4000, 1), version)), "1 triangle") << version;
        EXPECT_EQ(inspect_fbx(fbx(8, chain(8, 1), version), { 100, 8 }).error, "") << version;
        EXPECT_EQ(inspect_fbx(fbx(9, chain(9, 1), version), { 100, 8 }).error, "nodes are nested more than 8 deep")
            << version;
        FbxRecord nested { "Nested", {}, {} };
        for (int depth = 1; depth < 1002; ++depth)
            nested = FbxRecord { "Nested", {}, { nested } };
        EXPECT_EQ(outcome(folder, fbx_of({ nested }, version)), "brackets are nested more than 1000 deep") << version;
    }
    row.ours("read on a deep stack; refused beyond 5000 Models or 1000 brackets");
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
