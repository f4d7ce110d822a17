// SPDX-License-Identifier: Apache-2.0
// vmframes on the command line: what it refuses, and what it writes.
#include "command_test.h"
#include "image_count.h"

#include <OpenImageIO/imagebuf.h>

#include <cstdlib>

using namespace vmlight;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

namespace {

class Vmframes : public CommandTest
{
protected:
    Vmframes()
    {
        write("quad.obj", kQuad);
        make_sky({ 1, 2, 3 });
    }
    double mean(const std::string& name) const
    {
        double sum = 0;
        const Pixels all = pixels(name);
        for (const float value : all.values)
            sum += double(value);
        return sum / double(all.values.size());
    }
    const std::string few = " --size 16 --spp 4", small = few + " --resolution 16 --samples 4 --cfem-resolution 16";
};

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

// The open quad sends out the sky's one colour.
TEST_F(Vmframes, AnExrIsTheLight)
{
    done("vmframes quad.obj sky.exr -o a.exr --layers lit,depth,visibility --elevation 0 --fill 4" + small);
    EXPECT_THAT(channel_names("a.exr"),
                testing::UnorderedElementsAre("R", "G", "B", "A", "lit.R", "lit.G", "lit.B", "depth.Z", "visibility"));
    OIIO::ImageBuf image(path("a.exr"));
    EXPECT_NEAR(image.getchannel(8, 8, 0, 0), 1, 1e-6);
    EXPECT_NEAR(image.getchannel(8, 8, 0, 2), 3, 3e-6);
    EXPECT_EQ(image.getchannel(8, 8, 0, 3), 1);
    const std::vector<std::string> channels = channel_names("a.exr");
    const auto visibility = std::find(channels.begin(), channels.end(), "visibility") - channels.begin();
    EXPECT_NEAR(image.getchannel(8, 8, 0, int(visibility)), 1, 1e-6); // an open quad
    EXPECT_EQ(attribute("a.exr", "colorInteropID"), "lin_rec709_scene");
    done("vmframes quad.obj sky.exr -o b.exr --elevation 0 --fill 4 --exposure 1 --format half" + small);
    EXPECT_NEAR(OIIO::ImageBuf(path("b.exr")).getchannel(8, 8, 0, 0), 2, 1e-3);
}

TEST_F(Vmframes, AutoExposureBringsTheObjectToMiddleGrey)
{
    EXPECT_THAT(done("vmframes quad.obj sky.exr -o a.exr --elevation 0 --exposure auto --ground white" + small),
                HasSubstr("exposure: -"));
    OIIO::ImageBuf image(path("a.exr"));
    double luminance = 0;
    for (int c = 0; c < 3; ++c)
        luminance += std::vector<double> { 0.2126, 0.7152, 0.0722 }[size_t(c)] * double(image.getchannel(8, 8, 0, c));
    EXPECT_NEAR(luminance, 0.18, 0.02); // the ground is in the way of a little
    EXPECT_THAT(done("vmframes quad.obj sky.exr -o a.exr --elevation 0" + small), HasSubstr("brings the mean to 0.18"));
}

TEST_F(Vmframes, FramesTurnOnceAround)
{
    const std::string line = "vmframes " + kSpot + " " + kSky + small + " --frames 1-4 -o ";
    done(line + "'a.##.exr' --turntable --contact-sheet sheet.png");
    EXPECT_THAT(names("a."), ElementsAre("a.01.exr", "a.02.exr", "a.03.exr", "a.04.exr"));
    EXPECT_TRUE(exists("sheet.png"));
    // Turning the object by a quarter is seen by a camera that goes a quarter the other way, in light turned along.
    done("vmframes " + kSpot + " " + kSky + small + " --azimuth -90 --env-rotate 0,-90,0 -o b.exr");
    done("vmframes " + kSpot + " " + kSky + small + " --rotate 0,90,0 -o c.exr");
    const Pixels second = pixels("a.02.exr"), other = pixels("c.exr");
    ASSERT_EQ(second.values.size(), other.values.size());
    expect_same_pixels("b.exr", "c.exr", 1e-3f);
    done(line + "film.gif --turn-environment");
    EXPECT_EQ(image_count(path("film.gif")), 4);
    EXPECT_THAT(names(), Not(testing::Contains(HasSubstr(".part"))));
}

TEST_F(Vmframes, FilmsAreMadeByFfmpeg)
{
    const std::string line = "vmframes quad.obj sky.exr --frames 1-3 --turntable -o film.mp4" + small;
    if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) {
        refused(2, "films need ffmpeg, which is not installed", line);
        GTEST_SKIP() << "ffmpeg is not installed";
    }
    done(line);
    EXPECT_EQ(read("film.mp4").substr(4, 4), "ftyp");
    EXPECT_THAT(names(), Not(testing::Contains(HasSubstr(".part"))));
}

TEST_F(Vmframes, ModelsAreCompared)
{
    const std::string text = done("vmframes " + kSpot + " " + kSky + small
                                  + " --reference-samples 8 --side-by-side ao,paper,lobe,sh,cells,reference -o a.exr");
    EXPECT_THAT(text, HasSubstr("relative RMS against reference: ao "));
    EXPECT_EQ(pixels("a.exr").width, 6 * 16);
    EXPECT_THAT(attribute("a.exr", "vmlight:compared"), HasSubstr("against reference: ao "));
    EXPECT_THAT(done("vmframes " + kSpot + " " + kSky + small + " --wipe paper,paper -o b.png"),
                HasSubstr("against paper: paper 0.0000"));
}

TEST_F(Vmframes, MapsAndTexturesThatAreThereAreUsed)
{
    const std::string line = "vmframes " + kSpot + " " + kSky, filter = " --cfem-resolution 16";
    done(line + small + " --keep kept -o a.exr");
    EXPECT_THAT(names("", "kept"), ElementsAre("spot_lightmap.exr", "spot_vismap.exr"));
    EXPECT_THAT(done(line + few + filter + " --vismap kept/spot_vismap.exr -o b.exr"), Not(HasSubstr("bake:")));
    expect_same_pixels("a.exr", "b.exr", 0);
    // The lightmap itself, through OIIO's texture system: the margin and other filters alone are different.
    done("vmframes " + kSpot + " --texture kept/spot_lightmap.exr --size 16 --spp 4 -o c.exr");
    EXPECT_NEAR(mean("c.exr"), mean("a.exr"), 0.2 * mean("a.exr"));
    // A sequence, and a recipe that is lit as it is looked up.
    for (const char* name : { "t.1.exr", "t.2.exr" })
        write(name, read("kept/spot_lightmap.exr"));
    done("vmframes " + kSpot + " --texture 't.#.exr' --size 16 --spp 4 --frames 1-2 -o 'd.#.exr'");
    expect_same_pixels("c.exr", "d.2.exr", 0);
    refused(1, "\"t.3.exr\"", "vmframes " + kSpot + " --texture 't.#.exr' --size 16 --frames 3 -o 'e.#.exr'");
    write("live.lightmap", "vismap = \"kept/spot_vismap.exr\"\nenvironment = \"" + kSky + "\"\n");
    done("vmframes " + kSpot + " --texture live.lightmap?cfem_resolution=16 --size 16 --spp 4 -o f.exr");
    expect_same_pixels("c.exr", "f.exr", 1e-3f);
    EXPECT_THAT(done("vmframes quad.obj " + kSky + few + " --vismap kept/spot_vismap.exr -o g.png"),
                HasSubstr("was baked of another mesh than \"quad.obj\""));
    write("bare.obj", kQuadWithoutUv);
    EXPECT_THAT(done("vmframes bare.obj sky.exr --keep made -o d.png" + small), HasSubstr("no UVs; "));
    EXPECT_THAT(names("", "made"), testing::Contains("bare_unwrapped.glb"));
    refused(1, "texture coordinates", "vmframes bare.obj sky.exr --vismap kept/spot_vismap.exr -o e.png" + few);
}

TEST_F(Vmframes, SeveralObjectsAreInEachOthersWay)
{
    write("roof.obj",
          "v -9 2 -9\nv 9 2 -9\nv 9 2 9\nv -9 2 9\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 -1 0\n"
          "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
    const std::string line = "vmframes quad.obj sky.exr --look-at 0,0,0 --elevation 0 -o ";
    done(line + "open.exr" + small);
    done(line + "under.exr --object roof.obj" + small);
    EXPECT_LT(pixels("under.exr").greatest(), 0.99f * pixels("open.exr").greatest());
    done(line + "shadow.exr --ground shadow" + small);
    expect_finite("shadow.exr");
}

// Each frame is the picture of its own files, where the first one's camera stands.
TEST_F(Vmframes, MeshesMayHaveAFileForEachFrame)
{
    const auto roof = [](const std::string& height) {
        return "v -9 " + height + " -9\nv 9 " + height + " -9\nv 9 " + height + " 9\nv -9 " + height
            + " 9\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 -1 0\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";
    };
    write("roof.1.obj", roof("3"));
    write("roof.2.obj", roof("2"));
    const std::string lit = " sky.exr --look-at 0,0,0 --fov 0 --elevation 0";
    // A further object that moves shades one that stays.
    const std::string quad = "vmframes quad.obj" + lit + small;
    EXPECT_EQ(count(done(quad + " --object roof.#.obj --frames 1-2 -o over.#.exr"), "WARNING"), 0u);
    for (const std::string frame : { "1", "2" }) {
        done(quad + " --object roof." + frame + ".obj -o one.exr");
        expect_same_pixels("over." + frame + ".exr", "one.exr", 0);
    }
    EXPECT_NE(pixels("over.1.exr").values, pixels("over.2.exr").values);
    // The mesh itself, with a ground, by several models, and with the maps of makevismap --frames.
    for (const char* frame : { "1", "2" }) {
        std::string mesh = kQuad; // its upper edge leans
        mesh.replace(mesh.find("v 1 1 0\nv -1 1 0"), 16, std::string("v 1 1 .") + frame + "\nv -1 1 ." + frame);
        write(std::string("lean.") + frame + ".obj", mesh + "v -1 -1 1\nv 1 1 1\nv 1 1 0\nf 5 6 7\n");
    }
    const std::string ground = lit + " --ground white --side-by-side ao,lobe";
    done("vmframes lean.#.obj" + ground + small + " --frames 1-2 -o lean.#.exr");
    done("vmframes lean.2.obj" + ground + small + " -o one.exr");
    expect_same_pixels("lean.2.exr", "one.exr", 0);
    EXPECT_NE(pixels("lean.1.exr").values, pixels("lean.2.exr").values);
    done("makevismap lean.#.obj --frames 1-2 --resolution 16 --samples 4 -o vm.#.exr");
    const std::string given = few + " --cfem-resolution 16";
    EXPECT_EQ(count(done("vmframes lean.#.obj" + lit + given + " --vismap vm.#.exr --frames 1-2 -o given.#.exr"),
                    "another mesh"),
              0u);
    done("vmframes lean.2.obj" + lit + given + " --vismap vm.2.exr -o one.exr");
    expect_same_pixels("given.2.exr", "one.exr", 0);
    // A map of the first frame alone is one of another mesh in the second.
    EXPECT_EQ(count(done("vmframes lean.#.obj" + lit + given + " --vismap vm.1.exr --frames 1-2 -o given.#.exr"),
                    "\"vm.1.exr\": was baked of another mesh than \"lean.2.obj\""),
              1u);
    refused(1, "\"roof.4.obj\": ", quad + " --object roof.#.obj --frames 4 -o x.#.exr");
    const std::string reason = ": no such file, and no frames: a sequence needs --frames, such as 1-48";
    refused(2, "mesh: \"lean.#.obj\"" + reason, "vmframes lean.#.obj sky.exr -o x.png");
    refused(2, "object: \"roof.#.obj\"" + reason, "vmframes quad.obj sky.exr --object roof.#.obj -o x.png");
    refused(2, "vismap: \"vm.#.exr\"" + reason, "vmframes quad.obj sky.exr --vismap vm.#.exr -o x.png");
    refused(2, "--keep is for one map of each object",
            "vmframes lean.#.obj sky.exr --frames 1-2 --keep kept -o x.#.exr");
}

TEST_F(Vmframes, PicturesAreShownThroughTheConfig)
{
    const std::string line = "vmframes quad.obj sky.exr --colorconfig {config} --exposure -3 -o ";
    EXPECT_THAT(done(line + "a.png" + small), HasSubstr("display: "));
    EXPECT_TRUE(exists("a.png"));
    refused(1, "has no display \"Tube\"; it has ", line + "b.png --display Tube" + small);
}

TEST_F(Vmframes, StrandsAreDrawnOverAMesh)
{
    std::string obj = "v -.5 0 .2\nv .5 0 .3\nl 1 2\nv -.5 .2 .2\nv .5 .2 .3\nl 3 4\n";
    write("hair.obj", obj);
    done("vmframes quad.obj sky.exr -o bare.exr" + small);
    done("vmframes quad.obj sky.exr --object hair.obj --radius .3 --strand-color 0,1,0 -o both.exr --layers albedo"
         + small);
    EXPECT_LT(mean("both.exr"), mean("bare.exr"));
    const std::string hair = "vmframes quad.obj sky.exr --object hair.obj --radius .3 --strand-color 0,1,0 ";
    done(hair + "-o plain.exr" + small);
    done(hair + "--strand-specular .5 -o gloss.exr" + small);
    EXPECT_GT(mean("gloss.exr"), mean("plain.exr"));
    const Pixels all = pixels("both.exr");
    const float* centre = &all.values[size_t(8 * 16 + 8) * size_t(all.channels)];
    EXPECT_EQ(centre[0], 0); // green hair is in front
    EXPECT_GT(centre[1], 0);
    done("vmframes hair.obj sky.exr --radius .05 -o alone.png --samples 4" + few);
    for (const std::string flag : { "--format half", "--compression none" })
        refused(2, "only an EXR is stored so", "vmframes quad.obj sky.exr -o a.png " + flag + small);
    refused(2, "no object is strands", "vmframes quad.obj sky.exr --radius .1 -o a.png" + small);
    refused(2, "no object is strands", "vmframes quad.obj sky.exr --strand-color 1,0,0 -o a.png" + small);
    refused(2, "--strand-specular 1: no object is strands",
            "vmframes quad.obj sky.exr --strand-specular 1 -o a.png" + small);
    refused(2, "--strand-exponent 9: only --strand-specular uses it",
            "vmframes quad.obj sky.exr --object hair.obj --radius .1 --strand-exponent 9 -o a.png" + small);
    refused(2, "strand_exponent: 501 is not in [1, 500]",
            "vmframes quad.obj sky.exr --object hair.obj --radius .1 --strand-specular 1 --strand-exponent 501 -o a.png"
                + small);
    refused(2, "--white shows all white",
            "vmframes quad.obj sky.exr --object hair.obj --radius .1 --strand-color 1,0,0 --white -o a.png" + small);
}
