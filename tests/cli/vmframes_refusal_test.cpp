// SPDX-License-Identifier: Apache-2.0
// vmframes on the command line: what it warns of and refuses.
#include "vmframes_run.h"

#include <string>

using namespace vmlight;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace {

using Vmframes = VmframesTest;

} // namespace

// As makevismap does; what other tiles hold is baked too.
TEST_F(Vmframes, UvsWithoutLightAreWarnedOf)
{
    // The two corners at u = `from`.
    const auto moved = [&](const std::string& name, const std::string& from, const std::string& to) {
        std::string text = kQuad;
        for (const char* v : { " 0\n", " 1\n" })
            text.replace(text.find("vt " + from + v), 3 + from.size(), "vt " + to);
        write(name, text);
    };
    moved("left.obj", "0", "-0.5");
    EXPECT_THAT(done("vmframes left.obj sky.exr -o a.png" + small),
                HasSubstr("WARNING: left.obj: 2 of 2 triangles reach outside all UDIM tiles"));
    moved("wide.obj", "1", "2");
    EXPECT_THAT(done("vmframes wide.obj sky.exr -o a.png" + small), Not(HasSubstr("WARNING")));
    done("makevismap wide.obj --resolution 16 --samples 4 --udim 1001 -o vm.exr");
    EXPECT_THAT(done("vmframes wide.obj sky.exr --vismap vm.exr -o a.png" + few),
                HasSubstr("WARNING: wide.obj: no visibility map for UDIM tile 1002, which the mesh uses: no light "
                          "there"));
    write("half.obj", kQuad.substr(0, kQuad.rfind('f')) + "f 1/1/1 2/2/1 3/3/1\nf 1//1 3//1 4//1\n");
    EXPECT_THAT(done("vmframes half.obj sky.exr -o a.png" + small),
                HasSubstr("WARNING: half.obj: 1 of 2 triangles has no UVs: it occludes, but is not baked"));
}

TEST_F(Vmframes, AnAlbedoOfNoSurfaceIsWarnedOf)
{
    const std::string flags = " sky.exr -o a.png --bounce auto --bounce-albedo 0.3" + small,
                      nothing = "changes nothing";
    write("paint.mtl", "newmtl paint\nKd 0.2 0.4 0.8\n");
    write("painted.obj", "mtllib paint.mtl\nusemtl paint\n" + kQuad);
    EXPECT_THAT(done("vmframes painted.obj" + flags),
                HasSubstr("WARNING: bounce_albedo changes nothing: every material has a colour"));
    EXPECT_THAT(done("vmframes painted.obj --ground white" + flags), Not(HasSubstr(nothing)));
    EXPECT_THAT(done("vmframes painted.obj --white" + flags), Not(HasSubstr(nothing)));
    EXPECT_THAT(done("vmframes quad.obj" + flags), Not(HasSubstr(nothing)));
}

TEST_F(Vmframes, WrongUsageIsRefusedBeforeAnythingIsMade)
{
    const std::string line = "vmframes quad.obj sky.exr ";
    refused(2, "-o PICTURE is missing", line);
    refused(2, "MESH is missing", "vmframes -o a.png");
    refused(2, "ENVIRONMENT is missing, and there is no --texture", "vmframes quad.obj -o a.png");
    refused(2, "unexpected argument \"more.exr\"", line + "more.exr -o a.png");
    refused(2, "\"a.txt\": the extension must be exr, png", line + "-o a.txt");
    refused(2, "\"a.png\": 3 frames need ####", line + "-o a.png --frames 1-3");
    refused(2, "--turntable and --turn-environment need --frames", line + "-o a.png --turntable");
    refused(2, "\"pink\" is neither none, environment nor a colour", line + "-o a.png --background pink");
    refused(2, "--layers need an .exr", line + "-o a.png --layers depth");
    refused(2, "layers: \"shadow\" is not one of", line + "-o a.exr --layers shadow");
    refused(2, "--wipe needs two models", line + "-o a.png --wipe paper");
    refused(2, "--side-by-side needs two models or more", line + "-o a.png --side-by-side paper");
    refused(2, "give only one of --wipe and --side-by-side", line + "-o a.png --wipe ao,sh --side-by-side ao,sh");
    refused(2, "model: \"phong\" is not one of", line + "-o a.png --model phong");
    refused(2, "give only one of --vismap and --texture", line + "-o a.png --vismap v.exr --texture t.exr");
    refused(2, "\"t.##.exr\" is a sequence: --frames is missing", "vmframes quad.obj -o a.png --texture t.##.exr");
    refused(2, "the extension must be png, jpg, webp or tif", line + "-o a.png --contact-sheet sheet.exr");
    refused(2, "\"a.png\" is the file of frame 1 too", line + "-o a.png --contact-sheet a.png");
    refused(2, "--ground: \"whit\" is neither none, white, shadow nor a file", line + "-o a.png --ground whit");
    refused(2, "--exposure auto: there is no environment",
            "vmframes quad.obj --texture t.exr -o a.png --exposure auto");
    write("file");
    refused(2, "--keep: \"file\": is a file, not a folder", line + "-o a.png --keep file");
    refused(2, "\"quad.obj\" is a mesh: give it first, then the environment", "vmframes sky.exr quad.obj -o a.png");
    refused(2, "spp: 0 is not in [1, 4096]", line + "-o a.png --spp 0");
    refused(1, "\"a/b.png\": no such folder: \"a\"", line + "-o a/b.png");
    EXPECT_THAT(done("vmframes --help"),
                AllOf(HasSubstr("vmframes MESH [ENVIRONMENT] -o PICTURE"), HasSubstr("--turntable"),
                      HasSubstr("blackman-harris"), Not(HasSubstr("RECIPE"))));
}

TEST_F(Vmframes, FlagsThatCannotChangeThePictureAreRefused)
{
    const std::string line = "vmframes quad.obj sky.exr -o a.png ", exr = "vmframes quad.obj sky.exr -o a.exr ";
    const std::string texture = "vmframes quad.obj --texture t.exr -o a.png ";
    refused(2, "--azimuth 30: the camera of the file has its own place and lens", line + "--camera main --azimuth 30");
    refused(2, "--samples 4: the visibility map is made already", line + "--vismap v.exr --samples 4");
    refused(2, "--samples 4: the texture is shown as it is", texture + "--samples 4");
    refused(2, "--model paper: there is no environment", texture + "--model paper");
    refused(2, "--suns auto: there is no environment", texture + "--suns auto");
    refused(2, "--strand-specular 1: there is no environment", texture + "--strand-specular 1");
    refused(2, "--bounce-albedo 0.1: no bounced light is asked for", line + "--bounce-albedo 0.1");
    refused(2, "--suns on: the model reference traces the whole environment", line + "--model reference --suns on");
    refused(2, "unknown flag \"--ground-albedo\"", line + "--ground-albedo 0.1");
    refused(2, "--cfem-sanitize: there is no environment", texture + "--cfem-sanitize");
    refused(2, "--cfem-order 5: only the filter sh uses it", line + "--cfem-order 5");
    refused(2, "--model ao: the models are those that are compared", line + "--wipe ao,paper --model ao");
    refused(2, "--reference-samples 8: only the model reference uses it", line + "--reference-samples 8");
    refused(2, "--view Film: an EXR holds scene-linear light", exr + "--view Film");
    refused(2, "--background-blur 3: only --background environment is blurred", line + "--background-blur 3");
    make_sky({ 1, 1, 1 }, "paint.exr");
    refused(2, "--background environment: there is no environment",
            "vmframes quad.obj --texture paint.exr --background environment -o a.png");
    refused(2, "--model ao: the texture is shown as it is",
            "vmframes quad.obj sky.exr --texture paint.exr --model ao -o a.png");
    refused(2, "--fps 25: only films and GIFs have a speed", line + "--fps 25");
    refused(2, "--crease-angle 30: flat normals ignore it", line + "--normals flat --crease-angle 30");
    // A sheet is shown by a display, and what else is baked has samples.
    refused(1, "displays, views and looks need an OCIO config", exr + "--contact-sheet b.png --view Film" + small);
    refused(1, "\"v.exr\": no such file", line + "--vismap v.exr --ground white" + small);
    make_sky({ 1, -1, 1 }, "negative.exr");
    refused(1, "; set --cfem-sanitize to repair them", "vmframes quad.obj negative.exr -o a.png" + small);
}

TEST_F(Vmframes, InputsOfTheWrongKindAreRefused)
{
    refused(1, "\"no.obj\": ", "vmframes no.obj sky.exr -o a.png" + small);
    refused(1, "\"no.exr\": no such file", "vmframes quad.obj no.exr -o a.png" + small);
    refused(1, "\"sky.exr\": ", "vmframes quad.obj sky.exr --vismap sky.exr -o a.png" + few);
    refused(1, "has no camera \"main\"; it has none", "vmframes quad.obj sky.exr --camera main -o a.png" + small);
    refused(1, "displays, views and looks need an OCIO config",
            "vmframes quad.obj sky.exr --view Film -o a.png" + small);
    make_vismap();
    done("makecfem sky.exr -o cfem.exr --resolution 16");
    refused(1, "--background environment needs the environment itself",
            "vmframes quad.obj cfem.exr --background environment -o a.png" + small);
    done("makecfem {sky} --suns auto --stack -o split.exr --resolution 16");
    refused(
        1,
        "\"split.exr\": its suns were split off (makecfem --suns auto), and without them it is too dark; set --suns on",
        "vmframes quad.obj split.exr -o a.png" + small);
    refused(1, "the model reference needs the environment itself",
            "vmframes quad.obj cfem.exr --model reference -o a.png" + small);
}
