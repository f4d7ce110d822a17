// SPDX-License-Identifier: Apache-2.0
// Scene lists that are refused, and the line that errors name.
#include "mesh_fixture.h"

#include <vmlight/mesh/import/read_mesh.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <string>

using namespace mesh_files;
using testing::HasSubstr;

namespace {

class SceneListRefusal : public MeshFiles
{
protected:
    // What is said of a list with one instance of these keys.
    std::string said(const std::string& keys)
    {
        const std::string path = folder.write("bad.toml", "[[instance]]\n" + keys);
        Mesh mesh;
        std::string error;
        EXPECT_FALSE(read_instanced_mesh(mesh, path, {}, error)) << keys;
        const std::string head = "\"" + path + "\": ";
        EXPECT_EQ(error.substr(0, head.size()), head);
        EXPECT_EQ(error.find('\n'), std::string::npos);
        return error.substr(std::min(error.size(), head.size()));
    }
};

} // namespace

TEST_F(SceneListRefusal, CyclesAndMissingFilesAreNamed)
{
    folder.write("b.toml", "[[instance]]\nmesh = \"a.toml\"\n");
    const std::string a = folder.write("a.toml", "[[instance]]\nmesh = \"b.toml\"\n");
    Mesh mesh;
    std::string error;
    EXPECT_FALSE(read_instanced_mesh(mesh, a, {}, error));
    EXPECT_EQ(error,
              "\"" + a + "\": line 1: \"" + (folder / "b.toml") + "\": line 1: \"" + a + "\": \"" + a
                  + "\" contains itself");
    EXPECT_EQ(said("mesh = \"gone.obj\"\n"), "line 1: \"" + (folder / "gone.obj") + "\": no such file");
}

TEST_F(SceneListRefusal, ErrorsOfAnInstanceNameTheLineOfTheKey)
{
    folder.write("quad.obj", kQuadObj);
    const std::string mesh = "mesh = \"quad.obj\"\n";
    EXPECT_EQ(said("translate = [1, 2, 3]\n"), "line 1: an instance without mesh, the path of a file in quotes");
    EXPECT_EQ(said("mesh = 3\n"), "line 2: an instance without mesh, the path of a file in quotes");
    EXPECT_EQ(said(mesh + "colour = 1\n"), "line 3: unknown key \"colour\" of an instance");
    EXPECT_EQ(said(mesh + "translate = [1, 2]\n"), "line 3: translate is not three numbers in brackets");
    EXPECT_EQ(said(mesh + "rotate = 90\n"), "line 3: rotate is not three numbers in brackets");
    EXPECT_EQ(said(mesh + "scale = [\"1\", 2, 3]\n"), "line 3: scale is not one number, or three numbers in brackets");
    EXPECT_THAT(said(mesh + "scale = 0\n"), HasSubstr("line 3: the transform is singular"));
    EXPECT_THAT(said(mesh + "scale = [1, 0, 1]\n"), HasSubstr("line 3: the transform is singular"));
    EXPECT_THAT(said(mesh + "matrix = [1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0]\n"), HasSubstr("singular"));
    EXPECT_EQ(said(mesh + "scale = inf\n"), "line 1: the transform is not finite");
    EXPECT_EQ(said(mesh + "translate = [nan, 0, 0]\n"), "line 1: the transform is not finite");
    EXPECT_EQ(said(mesh + "matrix = [1, 2, 3]\n"), "line 3: matrix is not 12 or 16 numbers in brackets, row by row");
    EXPECT_EQ(said(mesh + "matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2]\n"),
              "line 3: the last row of matrix is not 0, 0, 0, 1");
    EXPECT_EQ(said(mesh + "scale = 2\nmatrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]\n"),
              "line 4: matrix stands for translate, rotate and scale: give one or the others");
    EXPECT_EQ(said(mesh + "bake = 1\n"), "line 3: bake is neither true nor false");
    EXPECT_EQ(said(mesh + "name = 1\n"), "line 3: name is not a string");
    EXPECT_EQ(said(mesh + "material = [1]\n"), "line 3: material is neither a name in quotes nor an array of them");
    EXPECT_THAT(said(mesh + "material = \"Bark\"\n"),
                HasSubstr("line 1: \"" + (folder / "quad.obj") + "\": no material"));
    EXPECT_THAT(said(mesh + "[[tree]]\n"), HasSubstr("unknown key \"tree\""));
    EXPECT_THAT(said(mesh + "scale = tiny\n"), HasSubstr("line 3: not TOML"));
    EXPECT_THAT(said(mesh + "scale = [-1, 1, 1]\n[[instance]]\nmesh = \"\"\n"),
                HasSubstr("line 5: an instance without"))
        << "a mirror is allowed";
}

TEST_F(SceneListRefusal, TheExtensionIsThatOfASceneListWhateverIsInside)
{
    Mesh mesh;
    std::string error;
    const std::string none = folder.write("none.toml", "title = \"village\"\n");
    EXPECT_FALSE(read_instanced_mesh(mesh, none, {}, error));
    EXPECT_EQ(error, "\"" + none + "\": unknown key \"title\": a scene list has tables [[instance]] alone");
    const std::string empty = folder.write("empty.toml", "");
    EXPECT_FALSE(read_instanced_mesh(mesh, empty, {}, error));
    EXPECT_EQ(error, "\"" + empty + "\": no [[instance]]");
}
