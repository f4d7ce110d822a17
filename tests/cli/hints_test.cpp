// SPDX-License-Identifier: Apache-2.0
// What an error tells the user to do must work where it is said.
#include "command_test.h"

using namespace vmlight;
using testing::HasSubstr;

namespace {

class Hints : public CommandTest
{
protected:
    void SetUp() override
    {
        make_vismap();
        make_sky({ 1, 1, 1 });
        make_sky({ 1, -1, 1 }, "negative.exr");
    }
};

} // namespace

TEST_F(Hints, AFlagIsOneOfTheExecutable)
{
    refused(1, "; set --sanitize to repair them", "makecfem negative.exr -o x.exr");
    done("makecfem negative.exr --sanitize -o x.exr");
    refused(1, "; set --cfem-sanitize to repair them", "makelightmap vm.exr negative.exr -o x.exr");
    done("makelightmap vm.exr negative.exr --cfem-sanitize -o x.exr");
}

TEST_F(Hints, AKeyIsOneOfTheRecipe)
{
    write("x.cfem", "environment = \"negative.exr\"\n");
    refused(1, "; set sanitize to repair them", "makelightmap vm.exr x.cfem -o x.exr");
    write("x.cfem", "environment = \"negative.exr\"\nsanitize = true\n");
    done("makelightmap vm.exr x.cfem -o x.exr");
}

TEST_F(Hints, AMeshIsNoImage)
{
    write("quad.OBJ", kQuad);
    const std::string bake = ": a mesh, not an image; bake it with makevismap first",
                      other = ": a mesh, not an image\n";
    refused(1, "\"quad.OBJ\"" + bake, "makelightmap quad.OBJ sky.exr -o x.exr");
    refused(1, "\"quad.OBJ\"" + other, "makelightmap vm.exr quad.OBJ -o x.exr");
    refused(1, "\"quad.OBJ\"" + other, "makelightmap vm.exr sky.exr --albedo quad.OBJ -o x.exr");
    refused(1, "\"quad.glb\"" + other, "makecfem quad.glb -o x.exr");
    const std::string terrain = ": an image, not a mesh: to read it as terrain, give the distance between its pixels";
    for (const std::string sky : { "sky.exr", "sky.hdr", "sky.png", "sky.jpg" }) {
        make_sky({ 1, 1, 1 }, sky);
        refused(1, "\"" + sky + "\"" + terrain, "makevismap " + sky + " -o x.exr");
    }
    refused(1, "\"vm.exr\": a map that vmlight made, not a mesh: pass the mesh", "makevismap vm.exr -o x.exr");
    refused(1, "\"vm.exr\": a map that vmlight made, not a mesh", "vmframes vm.exr sky.exr -o x.png");
}

TEST_F(Hints, SpellingsOfOtherToolsAreKnown)
{
    for (const char* flag : { "-h", "-help", "--help" })
        EXPECT_THAT(done(std::string("makecfem ") + flag), HasSubstr("Usage: makecfem"));
    EXPECT_THAT(done("makecfem -V"), testing::ContainsRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
    done("makecfem sky.exr --output a.exr");
    done("makecfem sky.exr --output=b.exr");
    EXPECT_TRUE(exists("a.exr") && read("a.exr") == read("b.exr"));
    refused(2, "-o needs a value: OUTPUT.exr", "makecfem sky.exr --output");
}
