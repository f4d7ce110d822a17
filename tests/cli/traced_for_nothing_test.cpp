// SPDX-License-Identifier: Apache-2.0
// What changes nothing in light that is traced: it says so, and traces nothing.
#include "command_test.h"

#include <vmlight/base/work_counts.h>

using namespace vmlight;
using testing::HasSubstr;
using testing::Not;

namespace {

class TracedForNothing : public CommandTest
{
protected:
    // A floor and a wall, as one mesh and as a mesh with an occluder.
    TracedForNothing()
    {
        write("corner.obj",
              "v 0 0 1\nv 1 0 1\nv 1 0 -1\nv 0 0 -1\nv 0 1 1\nv 0 1 -1\n"
              "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 1 0\nvt 1 1\n"
              "f 1/1 2/2 3/3 4/4\nf 1/2 4/3 6/6 5/5\n");
        write("floor.obj", "v 0 0 1\nv 1 0 1\nv 1 0 -1\nv 0 0 -1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
        write("wall.obj", kWall);
        write("corner.vismap", "mesh = \"corner.obj\"\nresolution = 32\nsamples = 64\n");
        write("shaded.vismap", "mesh = \"floor.obj\"\noccluder = [\"wall.obj\"]\nresolution = 32\nsamples = 64\n");
        make_sky({ 1, 1, 1 });
        make_sky({ 1, 1, 1 }, "white.exr", 32, 32);
    }
    const std::string kWall = "v 0 0 1\nv 0 0 -1\nv 0 1 -1\nv 0 1 1\nf 1 2 3 4\n";
};

} // namespace

TEST_F(TracedForNothing, BlackLight)
{
    make_sky({ 0, 0, 0 }, "night.exr");
    done("makevismap corner.vismap -o vm.exr");
    const int64_t bounce = work_counts().bounce_rays, suns = work_counts().sun_rays, meshes = work_counts().meshes_read;
    for (const char* model : { "auto", "paper" }) {
        const std::string said = done(std::string("makelightmap vm.exr night.exr --mesh corner.obj --albedo white.exr "
                                                  "--suns auto --bounce auto --explain -o lit.exr --model ")
                                      + model);
        EXPECT_THAT(said, HasSubstr("bounce: none, as the light is black"));
        EXPECT_THAT(said, testing::ContainsRegex("bounce +off +- +the light is black"));
        EXPECT_THAT(said, testing::ContainsRegex("suns +off +- +the light has no small strong source"));
        EXPECT_EQ(pixels("lit.exr").greatest(), 0);
    }
    EXPECT_EQ(work_counts().bounce_rays, bounce);
    EXPECT_EQ(work_counts().sun_rays, suns);
    EXPECT_EQ(work_counts().meshes_read, meshes);
}

TEST_F(TracedForNothing, AlbedosOfNothing)
{
    const std::string end = " sky.exr --albedo white.exr --bounce auto -o lit.exr ", nothing = "changes nothing: ";
    EXPECT_THAT(done("makelightmap corner.vismap" + end + "--ground-albedo 0.3"),
                HasSubstr("WARNING: ground_albedo changes nothing: the visibility map has no ground"));
    EXPECT_THAT(done("makelightmap corner.vismap" + end + "--bounce-albedo 0.3"),
                HasSubstr("WARNING: bounce_albedo changes nothing: the visibility map has no occluder"));
    EXPECT_THAT(done("makelightmap corner.vismap" + end), Not(HasSubstr(nothing)));
    EXPECT_THAT(done("makelightmap shaded.vismap" + end + "--bounce-albedo 0.3"), Not(HasSubstr(nothing)));
    done("makevismap corner.vismap --ground -o vm.exr");
    EXPECT_THAT(done("makelightmap vm.exr --mesh corner.obj" + end + "--ground-albedo 0.3"), Not(HasSubstr(nothing)));
    write("paint.mtl", "newmtl paint\nKd 0.2 0.4 0.8\n");
    write("wall.obj", "mtllib paint.mtl\nusemtl paint\n" + kWall);
    EXPECT_THAT(done("makelightmap shaded.vismap" + end + "--bounce-albedo 0.3"),
                HasSubstr("bounce_albedo changes nothing: every occluder that lights a texel has a colour"));
}
