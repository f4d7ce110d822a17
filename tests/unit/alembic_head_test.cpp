// SPDX-License-Identifier: Apache-2.0
// Alembic files by their first bytes, with and without the Alembic library.
#include "mesh_fixture.h"

#include <vmlight/mesh/import/importer.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/recipe/unused_flags.h>

#include <gmock/gmock.h>

using namespace mesh_files;
using testing::HasSubstr;

namespace {

const std::string kFinished = std::string("Ogawa\xff\0\1\x10\0\0\0\0\0\0\0", 16) + std::string(8, '\0');

} // namespace

TEST_F(MeshFiles, AnAlembicFileIsKnownByItsContent)
{
    for (const char* name : { "a.abc", "a.obj", "noname" }) {
        const std::string said = refusal(folder.write(name, kFinished));
#if VMLIGHT_HAS_ALEMBIC
        EXPECT_THAT(said, testing::StartsWith("damaged or cut short, says the Alembic library: "));
#else
        EXPECT_EQ(said,
                  "an Alembic file, but this vmlight was built without Alembic: build it where the Alembic library is "
                  "installed (Debian sid: libalembic-graphics-dev), or export the mesh as glTF, OBJ or PLY, a file "
                  "for each frame");
#endif
    }
}

TEST_F(MeshFiles, AnAlembicFileThatCannotBeReadSaysWhatToDo)
{
    EXPECT_THAT(refusal(folder.write("a.abc", "\x89HDF\r\n\x1a\n and more")),
                HasSubstr("abcconvert -toOgawa OLD.abc NEW.abc"));
    std::string unfinished = kFinished;
    unfinished[5] = '\0';
    EXPECT_EQ(refusal(folder.write("a.abc", unfinished)), "an Alembic file that was never finished: export it again");
    for (const char* text : { "", "Oga", "noise" })
        EXPECT_EQ(refusal(folder.write("a.abc", text)), "not an Alembic file: it starts neither as Ogawa nor as HDF5");
    EXPECT_NE(refusal(folder.write("a.abc", "Ogawa")), "");
}

TEST_F(MeshFiles, OnlyAlembicFilesHaveFrames)
{
    EXPECT_TRUE(has_time(folder.write("a.obj", kFinished))) << "content beats the extension";
    EXPECT_FALSE(has_time(folder.write("b.abc", kQuadObj)));
    EXPECT_FALSE(has_time(folder.write("c.obj", kQuadObj)));
    EXPECT_TRUE(has_time(folder / "gone.abc"));
    EXPECT_FALSE(has_time(folder / "gone.glb"));
    EXPECT_FALSE(has_time(""));
    VismapRecipe recipe;
    recipe.mesh = folder / "c.obj";
    recipe.mesh_params.frame = 3;
    EXPECT_EQ(unused_reason(recipe, "frame"), "only Alembic files have frames");
    EXPECT_EQ(unused_reason(recipe, "fps"), "");
    recipe.occluder = { folder / "c.obj", folder / "a.obj" };
    EXPECT_EQ(unused_reason(recipe, "frame"), "") << "an occluder has";
    recipe.mesh_params.frame = MeshParams::kFirstSample;
    EXPECT_EQ(unused_reason(recipe, "fps"), "no frame is given");
}

TEST_F(MeshFiles, AFrameIsInTheMetadataOfItsMapAlone)
{
    VismapRecipe recipe;
    recipe.mesh = folder.write("a.obj", kQuadObj);
    const auto said = [&](const char* name) {
        std::string error;
        const PixelSourcePointer source = open_source(recipe, error);
        EXPECT_TRUE(source) << error;
        const OIIO::ParamValue* value = source ? source->spec().find_attribute(name) : nullptr;
        return value ? value->get_string() : "none";
    };
    EXPECT_EQ(said("vmlight:up"), "file");
    EXPECT_EQ(said("vmlight:frame"), "none") << "maps stay as they were";
    EXPECT_EQ(said("vmlight:fps"), "none");
    recipe.mesh_params.frame = 12.5;
    EXPECT_EQ(said("vmlight:frame"), "12.5");
    EXPECT_EQ(said("vmlight:fps"), "24");
    EXPECT_EQ(recipe_text(recipe).find("fps"), std::string::npos);
    VismapRecipe again;
    std::string error;
    EXPECT_TRUE(read_recipe_text(again, recipe_text(recipe), "a.vismap", error)) << error;
    EXPECT_EQ(again.mesh_params.frame, 12.5);
    EXPECT_TRUE(read_recipe_text(again, "mesh = \"a.abc\"\nframe = \"first\"\n", "a.vismap", error)) << error;
    EXPECT_EQ(again.mesh_params.frame, MeshParams::kFirstSample);
}
