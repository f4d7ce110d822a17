// SPDX-License-Identifier: Apache-2.0
// Recipes on the command line.
#include "command_test.h"

#include <vmlight/base/format.h>

#include <filesystem>

using namespace vmlight;
using testing::HasSubstr;

namespace {

class Recipes : public CommandTest
{
protected:
    // The operands and flags of each stage of a small light.
    const std::string bake = "quad.obj --occluder lid.obj --resolution 16 --samples 16 --margin infinite ",
                      filter = "{sky} --resolution 32x16 --colorconfig {config} ",
                      turn = "--rotate 0,90,0.1 --exposure -0.3 ", light = "vm.exr cfem.exr " + turn;

    // vm.exr, cfem.exr and lit.exr, by flags.
    void make_all() const
    {
        write("quad.obj", kQuad);
        write("lid.obj", "v -9 -9 0.5\nv 1 -9 0.5\nv 1 9 0.5\nv -9 9 0.5\nf 1 2 3 4\n");
        done("makevismap " + bake + "-o vm.exr");
        done("makecfem " + filter + "-o cfem.exr");
        done("makelightmap " + light + "-o lit.exr");
    }
};

} // namespace

TEST_F(Recipes, ARecipeMakesWhatItsFlagsMake)
{
    make_all();
    std::filesystem::create_directory("recipes");
    write("recipes/hero.vismap",
          "mesh = \"../quad.obj\"\noccluder = [\"../lid.obj\"]\nresolution = 16\nsamples = 16\n"
          "margin = \"infinite\"\n");
    write("recipes/studio.cfem",
          format("environment = \"{}\"\nresolution = [32, 16]\ncolorconfig = \"{}\"\n", kSky, kConfig));
    write("recipes/hero.lightmap",
          "vismap = \"hero.vismap\"\ncfem = \"studio.cfem\"\nrotate = [0, 90, 0.1]\nexposure = -0.3\n");
    done("makevismap recipes/hero.vismap -o a.exr");
    done("makecfem recipes/studio.cfem -o b.exr");
    done("makelightmap recipes/hero.lightmap -o c.exr");
    EXPECT_TRUE(read("a.exr") == read("vm.exr"));
    EXPECT_TRUE(read("b.exr") == read("cfem.exr"));
    EXPECT_TRUE(read("c.exr") == read("lit.exr"));
    // A recipe can replace an image on the command line too.
    done("makelightmap recipes/hero.vismap recipes/studio.cfem " + turn + "-o d.exr");
    EXPECT_TRUE(read("d.exr") == read("lit.exr"));
    // A query may say all that the file does not.
    write("x.lightmap", "# whose paths start at the current folder\n");
    done("makelightmap x.lightmap?vismap=vm.exr&cfem=cfem.exr&rotate=0,90,0.1&exposure=-0.3 -o e.exr");
    EXPECT_TRUE(read("e.exr") == read("lit.exr"));
}

TEST_F(Recipes, FlagsOverrideTheQueryWhichOverridesTheFile)
{
    make_all();
    write("hero.lightmap", "vismap = \"vm.exr\"\ncfem = \"cfem.exr\"\nrotate = [1, 2, 3]\nexposure = 5\n");
    done("makelightmap hero.lightmap?exposure=7&rotate=4,5,6 -o a.exr --rotate 0,90,0.1 --exposure=-0.3");
    EXPECT_TRUE(read("a.exr") == read("lit.exr"));
    write("hero.vismap",
          "mesh = \"quad.obj\"\noccluder = [\"gone.obj\"]\nresolution = 16\nsamples = 16\n"
          "margin = \"infinite\"\n");
    done("makevismap --occluder lid.obj hero.vismap -o b.exr");
    EXPECT_TRUE(read("b.exr") == read("vm.exr"));
}

TEST_F(Recipes, APrintedRecipeMakesTheSameImage)
{
    make_all();
    std::string text;
    for (const auto& [line, recipe, image] : { std::tuple("makevismap " + bake, "p.vismap", "vm.exr"),
                                               { "makecfem " + filter, "p.cfem", "cfem.exr" },
                                               { "makelightmap " + light, "p.lightmap", "lit.exr" } }) {
        const auto before = contents();
        text = run(line + "--print-recipe").out;
        EXPECT_TRUE(contents() == before);
        write(recipe, text);
        const std::string again = line.substr(0, line.find(' ') + 1) + recipe;
        done(again + " -o again.exr");
        EXPECT_TRUE(read("again.exr") == read(image)) << text;
        EXPECT_EQ(run(again + " --print-recipe").out, text);
    }
    EXPECT_EQ(text, "vismap = \"vm.exr\"\ncfem = \"cfem.exr\"\nrotate = [0, 90, 0.1]\nexposure = -0.3\n");
    EXPECT_THAT(done("makelightmap vm.exr {sky} --print-recipe"), HasSubstr("environment = "));
    EXPECT_THAT(done("makelightmap vm.exr {sky} --is-cfem --print-recipe"), HasSubstr("cfem = "));
    refused(2, "--frames and --rotate-y cannot be saved in a recipe",
            "makelightmap " + light + "--frames 1-4 --print-recipe");
    refused(2, "exposure: 99 is not in", "makelightmap vm.exr {sky} --exposure=99 --print-recipe");
    refused_words(2, "\"caf\\xe9.obj\": not valid UTF-8, which recipes require",
                  { "makevismap", "caf\xe9.obj", "--print-recipe" });
    refused_words(1, "\"a\\x0ab.obj\": no such file", { "makevismap", "a\nb.obj", "-o", "x.exr" });
}

TEST_F(Recipes, ARecipeMakesTheSameImageWhereverItIsSaved)
{
    make_all();
    namespace fs = std::filesystem;
    fs::create_directories("sub/deeper");
    fs::create_directory("elsewhere");
    fs::create_directory_symlink("sub/deeper", "link");
    for (const auto& [line, extension, image] : { std::tuple("makevismap " + bake, ".vismap", "vm.exr"),
                                                  { "makecfem " + filter, ".cfem", "cfem.exr" },
                                                  { "makelightmap " + light, ".lightmap", "lit.exr" } })
        for (const std::string folder : { "", "./", "sub/", "sub/deeper/", "sub/../elsewhere/", "link/" }) {
            const std::string recipe = folder + "saved" + extension;
            EXPECT_EQ(done(line + "-o " + recipe), "");
            EXPECT_TRUE(!folder.empty() || read(recipe) == run(line + "--print-recipe").out);
            const std::string make = line.substr(0, line.find(' ') + 1);
            done(make + recipe + " -o again.exr");
            EXPECT_TRUE(read("again.exr") == read(image)) << recipe << "\n" << read(recipe);
            // From a folder in which nothing is.
            fs::current_path("elsewhere");
            done(make + "../" + recipe + " -o ../again.exr");
            fs::current_path("..");
            EXPECT_TRUE(read("again.exr") == read(image)) << recipe << "\n" << read(recipe);
            // Saved from where it is.
            done(make + recipe + " -o sub/twice" + extension);
            done(make + "sub/twice" + extension + " -o again.exr");
            EXPECT_TRUE(read("again.exr") == read(image)) << read("sub/twice" + std::string(extension));
        }
    EXPECT_EQ(read("sub/saved.lightmap"),
              "vismap = \"../vm.exr\"\ncfem = \"../cfem.exr\"\nrotate = [0, 90, 0.1]\nexposure = -0.3\n");
    EXPECT_EQ(done("makelightmap " + light + "--print-recipe -o sub/saved.lightmap"), "") << "is written, not printed";
}

TEST_F(Recipes, PathsInASavedRecipeLeadWhereTheyDid)
{
    namespace fs = std::filesystem;
    fs::create_directory("sub");
    const auto saved = [&](const std::string& line, const std::string& recipe) {
        done(line + " -o " + recipe);
        return read(recipe);
    };
    const std::string here = fs::current_path().string();
    EXPECT_EQ(saved("makevismap /a.obj --occluder b.obj --occluder sub/c.obj", "sub/x.vismap"),
              "mesh = \"/a.obj\"\noccluder = [\n    \"../b.obj\",\n    \"c.obj\",\n]\n");
    EXPECT_EQ(saved("makevismap <UDIM>/a.<UDIM>.obj", "sub/x.vismap"), "mesh = \"../<UDIM>/a.<UDIM>.obj\"\n");
    EXPECT_EQ(saved("makecfem a.hdr --colorconfig ocio://default", "sub/x.cfem"),
              "environment = \"../a.hdr\"\ncolorconfig = \"ocio://default\"\n");
    // A query's paths start at the current folder, wherever the recipe is.
    write("a.vismap", "# a recipe\n");
    EXPECT_EQ(saved("makelightmap a.vismap?mesh=a.obj&samples=4 b.cfem?environment=c.hdr", "sub/x.lightmap"),
              format("vismap = \"../a.vismap?mesh={}/a.obj&samples=4\"\n"
                     "cfem = \"../b.cfem?environment={}/c.hdr\"\n",
                     here, here));
    // The name of a tile is one of its recipe's keys.
    EXPECT_EQ(saved("makevismap a.obj", "a.1011.vismap"), "mesh = \"a.obj\"\nudim = 1001\n");
}

TEST_F(Recipes, WhatCannotBeSavedIsRefused)
{
    make_all();
    const std::string lit = "makelightmap vm.exr cfem.exr ";
    refused(2, "\"x.cfem\": output must be .exr, or .lightmap for a recipe", lit + "-o x.cfem");
    refused(2, "\"x.lightmap?exposure=1\": output must be .exr, or .lightmap", lit + "-o x.lightmap?exposure=1");
    refused(2, "\"x.<UDIM>.lightmap\": use <UDIM> in the paths of the recipe", lit + "-o x.<UDIM>.lightmap");
    refused(2, "--frames and --rotate-y cannot be saved in a recipe", lit + "--frames 1-4 -o x.lightmap");
    refused(2, "exposure: 99 is not in", lit + "--exposure 99 -o x.lightmap");
    refused(1, "\"none/x.lightmap\": no such folder: \"none\"", lit + "-o none/x.lightmap");
    write("empty.lightmap", "exposure = 1\n");
    refused(2, "vismap is missing", "makelightmap empty.lightmap -o x.lightmap");
    std::filesystem::create_directories("caf\xe9/sub");
    std::filesystem::current_path("caf\xe9/sub");
    std::filesystem::create_directory("../../to");
    std::filesystem::create_directory_symlink("../../to", "link");
    refused(2, "not valid UTF-8, which recipes require", "makecfem a.hdr -o link/x.cfem");
}

TEST_F(Recipes, AFaultyRecipeIsRefusedWithItsLine)
{
    write("bad.lightmap", "vismap = \"vm.exr\"\nrotat = [0, 90, 0]\n");
    refused(1, "\"bad.lightmap\" line 2: unknown parameter \"rotat\"; did you mean \"rotate\"?",
            "makelightmap bad.lightmap -o x.exr");
    refused(1, "no such file", "makelightmap gone.lightmap -o x.exr");
    refused(2, "unexpected argument \"more\"", "makelightmap bad.lightmap more -o x.exr");
    std::string noise;
    for (int i = 0; i < 256 * 16; ++i)
        noise += char(i);
    write("noise.cfem", noise);
    write("empty.cfem");
    std::filesystem::create_directory("folder.cfem");
    for (const std::string name : { "noise.cfem", "empty.cfem", "folder.cfem" })
        refused(1, "\"" + name + "\"", "makecfem " + name + " -o x.exr");
    write("good.lightmap", "exposure = 1\n");
    refused(1, "rotate: \"abc\" in \"abc\" is not a number", "makelightmap good.lightmap?rotate=abc -o x.exr");
    refused(2, "exposure: 99 is not in", "makelightmap good.lightmap --exposure 99 -o x.exr");
    refused(2, "-o OUTPUT.exr is missing", "makelightmap good.lightmap");
}

TEST_F(Recipes, AMissingInputIsNamedWithTheLineThatNamesIt)
{
    make_vismap();
    make_sky({ 1, 1, 1 });
    write("a.lightmap", "exposure = 1\n");
    refused(1, "\"a.lightmap\": vismap is missing", "makelightmap a.lightmap -o x.exr");
    write("b.lightmap", "vismap = \"vm.exr\"\n");
    refused(1, "\"b.lightmap\": environment or cfem is missing", "makelightmap b.lightmap -o x.exr");
    write("c.lightmap", "vismap = \"vm.exr\"\n\nenvironment = \"gone.exr\"\n");
    refused(1, "\"c.lightmap\" line 3: environment: \"gone.exr\": no such file", "makelightmap c.lightmap -o x.exr");
    refused(1, "ERROR: \"other.exr\": no such file", "makelightmap c.lightmap --environment other.exr -o x.exr");
    write("d.lightmap", "vismap = \"vm.exr\"\nenvironment = \"sky.exr\"\ncfem = \"sky.exr\"\n");
    refused(1, "\"d.lightmap\" line 3: cfem: environment is set too", "makelightmap d.lightmap -o x.exr");
    done("makelightmap d.lightmap --environment= -o cleared.exr");
    write("e.vismap", "mesh = \"gone.obj\"\n");
    write("e.lightmap", "vismap = \"e.vismap\"\nenvironment = \"sky.exr\"\n");
    refused(1, "\"e.lightmap\" line 1: vismap: \"e.vismap\" line 1: mesh: \"gone.obj\": no such file",
            "makelightmap e.lightmap -o x.exr");
    write("f.vismap", "samples = 1\n");
    refused(1, "\"f.vismap\": mesh is missing", "makevismap f.vismap -o x.exr");
}

TEST_F(Recipes, AnInputOfTheWrongStageIsRefused)
{
    make_all();
    write("studio.cfem", "environment = \"sky.exr\"\n");
    write("a.lightmap", "vismap = \"studio.cfem\"\ncfem = \"studio.cfem\"\n");
    refused(1, "\"a.lightmap\" line 1: vismap: \"studio.cfem\": is the recipe of a cfem, not of a vismap",
            "makelightmap a.lightmap -o x.exr");
    write("b.lightmap", "vismap = \"vm.exr\"\nenvironment = \"studio.cfem\"\n");
    refused(1, "\"studio.cfem\": is the recipe of a cfem, not of an environment", "makelightmap b.lightmap -o x.exr");
    write("c.lightmap", "vismap = \"vm.exr\"\nenvironment = \"cfem.exr\"\n");
    refused(1, "\"c.lightmap\" line 2: environment: \"cfem.exr\": is already filtered: use it as cfem",
            "makelightmap c.lightmap -o x.exr");
    write("d.lightmap", "vismap = \"vm.exr\"\ncfem = \"lit.exr\"\n");
    refused(1, "\"lit.exr\": is neither an environment nor a CFEM", "makelightmap d.lightmap -o x.exr");
}

TEST_F(Recipes, ARecipeThatReadsItselfIsRefused)
{
    make_all();
    const std::string rest = "vismap = \"vm.exr\"\ncfem = \"cfem.exr\"\n";
    write("self.lightmap", rest + "albedo = \"./self.lightmap\"\n");
    refused(1,
            "\"self.lightmap\" line 3: albedo: \"./self.lightmap\" reads itself: \"self.lightmap\" -> "
            "\"./self.lightmap\"",
            "makelightmap self.lightmap -o x.exr");
    write("a.lightmap", "albedo = \"b.lightmap\"\n" + rest);
    write("b.lightmap", "albedo = \"a.lightmap\"\n" + rest);
    refused(1, "\"a.lightmap\" reads itself: \"a.lightmap\" -> \"b.lightmap\" -> \"a.lightmap\"",
            "makelightmap a.lightmap -o x.exr");
    write("self.cfem", "environment = \"self.cfem\"\n");
    refused(1, "\"self.cfem\" reads itself", "makecfem self.cfem -o x.exr");
    // Not itself: the same file with another albedo.
    make_sky({ 0.5f, 0.5f, 0.5f });
    write("twice.lightmap", rest + "albedo = \"twice.lightmap?albedo=sky.exr\"\n");
    done("makelightmap twice.lightmap -o twice.exr");
    for (int link = 0; link < 70; ++link)
        write(format("{}.lightmap", link), rest + format("albedo = \"{}.lightmap\"\n", link + 1));
    refused(1, "\"64.lightmap\": more than 64 nested recipes", "makelightmap 0.lightmap -o x.exr");
}

TEST_F(Recipes, TheExamplesWork)
{
    const std::string examples = VMLIGHT_TEST_SOURCE "/configs/examples/";
    done("makevismap " + examples + "spot.vismap -o vm.exr");
    done("makecfem " + examples + "studio.cfem -o cfem.exr");
    done("makelightmap " + examples + "spot.lightmap -o lit.exr");
    done("makelightmap vm.exr cfem.exr --rotate 0,90,0 --exposure -2.2 -o expected.exr");
    EXPECT_TRUE(read("lit.exr") == read("expected.exr"));
}
