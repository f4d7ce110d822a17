// SPDX-License-Identifier: Apache-2.0
// vmcost on the command line: what it refuses, measures, and keeps from an earlier run.
#include "cost_run.h"

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <filesystem>

#include <cstdlib>

using namespace vmlight;
using OIIO::Strutil::replace;
using testing::ContainsRegex;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

namespace {

using Cost = CostTest;

} // namespace

TEST_F(Cost, WrongUsageIsRefusedBeforeAnythingIsMade)
{
    const std::string line = "vmcost step.obj sky.exr ";
    refused(2, "-o FOLDER is missing", line);
    refused(2, "ENVIRONMENT... is missing", "vmcost step.obj -o report");
    refused(2, "unknown flag \"--resolutions\"; did you mean --resolution?", line + "-o report --resolutions 8");
    refused(2, "resolution: 7 is not in [8, 4096] or \"auto\"", line + "-o report --resolution 7");
    refused(2, "unknown flag \"--format\"", line + "-o report --format half");
    write("file");
    refused(1, "\"file\": is a file, not a folder", line + "-o file");
    refused(1, "\"a/b\": no such folder: \"a\"", line + "-o a/b");
    refused(1, "folder \"/proc\" is not writable", line + "-o /proc/report");
    const std::string help = done("vmcost --help");
    EXPECT_THAT(help, HasSubstr("vmcost MESH ENVIRONMENT... -o FOLDER"));
    EXPECT_THAT(help, Not(HasSubstr("RECIPE")));
}

TEST_F(Cost, InputsOfTheWrongKindAreRefused)
{
    refused(1, "\"no.obj\": no such file", "vmcost no.obj sky.exr -o report" + small);
    refused(1, "\"no.exr\": no such file", "vmcost step.obj sky.exr no.exr -o report" + small);
    write("bare.obj", kQuadWithoutUv);
    refused(1, "texture coordinates", "vmcost bare.obj sky.exr -o report" + small);
    make_vismap();
    refused(1, "\"vm.exr\": is neither an environment nor a CFEM", "vmcost step.obj vm.exr -o report" + small);
}

// As makecfem reads an environment.
TEST_F(Cost, EnvironmentsAreReadAsTheyAreFiltered)
{
    make_sky({ 1, 2, 3 }, "cross.exr", 64, 48);
    refused(1, "64x48 pixels is the shape of a cube map's cross", "vmcost step.obj cross.exr -o report" + small);
    OIIO::ImageBuf layers(path("sky.exr"));
    layers.read(0, 0, true, OIIO::TypeFloat);
    layers.specmod().channelnames = { "View.Combined.R", "View.Combined.G", "View.Combined.B" };
    ASSERT_TRUE(layers.write(path("layers.exr")));
    refused(1, "choose a layer with --layer (--albedo-layer): View.Combined",
            "vmcost step.obj layers.exr -o report" + small);
    cost("layers.exr --layer View.Combined --layout latlong" + small);
    const std::string page = read("report/report.html");
    EXPECT_THAT(page, HasSubstr("makelightmap step_vismap.exr layers.exr"));
    EXPECT_THAT(page, HasSubstr("--layer View.Combined --layout latlong"));
}

TEST_F(Cost, BadPixelsAreRefusedAndReplacedOnRequest)
{
    make_sky({ 1 - 2, 2 - 2, 3 - 2 }, "negative.exr");
    const Result result = run("vmcost step.obj negative.exr -o report" + small);
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.err, ContainsRegex("^vmcost ERROR: \"negative.exr\": .*sanitize"));
    cost("negative.exr --sanitize" + small);
}

TEST_F(Cost, ADarkEnvironmentAndATinyMeshAreRefused)
{
    make_sky({ 0, 0, 0 }, "black.exr");
    Result result = run("vmcost step.obj black.exr -o report" + small);
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(result.err, "vmcost ERROR: \"black.exr\": no light reaches the mesh\n");
    const std::string narrow = replace(replace(kQuad, "vt 1", "vt 0.1"), "vt 0 1", "vt 0 0.1");
    write("tiny.obj", replace(narrow, "vt 0.1 1", "vt 0.1 0.1"));
    result = run("vmcost tiny.obj sky.exr -o report" + small);
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.err,
                ContainsRegex("the mesh covers [0-9]+ of 16x16 texels; at least 64 are needed: raise --resolution"));
}

TEST_F(Cost, LightOnASingleTexelIsRefused)
{
    // A floor, and a speck of one texel that looks the other way, where all the light is.
    write("speck.obj",
          "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 5 0 0\nv 5 1 0\nv 6 1 0\nv 6 0 0\n"
          "vt 0 0\nvt 0.8 0\nvt 0.8 1\nvt 0 1\nvt 0.94 0\nvt 0.94 0.06\nvt 1 0.06\nvt 1 0\nvn 0 0 1\n"
          "vn 0 0 -1\nf 1/1/1 2/2/1 3/3/1 4/4/1\nf 5/5/2 6/6/2 7/7/2 8/8/2\n");
    OIIO::ImageBuf back(OIIO::ImageSpec(64, 32, 3, OIIO::TypeFloat));
    OIIO::ImageBufAlgo::fill(back, { 1.0f, 1.0f, 1.0f }, OIIO::ROI(0, 4, 0, 32));
    ASSERT_TRUE(back.write(path("back.exr"))) << back.geterror();
    const Result result = run("vmcost speck.obj back.exr -o report" + small);
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(result.err,
              "vmcost ERROR: \"back.exr\": light reaches too few texels to estimate an error: raise --resolution\n");
}

TEST_F(Cost, GnuplotIsLookedForBeforeTheWork)
{
    const std::string before = std::getenv("PATH");
    std::filesystem::create_directory("empty");
    ::setenv("PATH", path("empty").c_str(), 1);
    refused(1, "gnuplot is missing: install the package gnuplot-nox",
            "vmcost step.obj sky.exr -o report" + small_with_plots);
    cost("sky.exr" + small);
    EXPECT_THAT(names("", "report"), Each(Not(testing::EndsWith(".svg"))));
    ::setenv("PATH", before.c_str(), 1);
}

TEST_F(Cost, AllModelsAreExactUnderConstantLight)
{
    cost("sky.exr" + small + " --reference-samples 512");
    std::map<std::string, nlohmann::json> best;
    for (const auto& row : rows())
        if (row["samples"] == 256 || row["model"] == "traced")
            best[row["model"]] = row;
    for (const char* model : { "ao", "paper", "lobe" }) {
        ASSERT_EQ(best.count(model), 1u) << model;
        EXPECT_LT(double(best[model]["rmse"]), 0.03) << model;
        EXPECT_LT(std::abs(double(best[model]["bias"])), 0.01) << model;
    }
}

TEST_F(Cost, ErrorsAreTheSameForAnyNumberOfThreads)
{
    std::vector<nlohmann::json> found;
    for (const std::string threads : { "1", "2" }) {
        cost("checker.exr" + small + " --threads " + threads);
        nlohmann::json all = rows();
        for (auto& row : all)
            for (const char* timing : { "bake_seconds", "light_seconds", "shade_seconds", "shade_spread" })
                row.erase(timing);
        found.push_back(all);
    }
    EXPECT_FALSE(found[0].empty());
    EXPECT_EQ(found[0], found[1]);
}

TEST_F(Cost, EnvironmentsBecomeSceneLinearAndNamesStayApart)
{
    std::filesystem::create_directory("other");
    make_sky({ 3, 1, 1 }, "other/sky.exr");
    const std::string color = " --colorconfig {config} --colorspace ";
    EXPECT_THAT(cost("sky.exr other/sky.exr" + color + "lin_rec709_scene" + small),
                ContainsRegex("sky: 16x8, .* -> ACEScg"));
    EXPECT_EQ(values("environment"), (std::set<std::string> { "sky", "sky_2" }));
    refused(1, "no_such_space", "vmcost step.obj sky.exr -o new" + color + "no_such_space");
}

TEST_F(Cost, QuietPrintsNothing)
{
    std::string printed = done("vmcost step.obj sky.exr -o report --quiet" + small);
    // Only a warning, of a machine that is busy now.
    const size_t busy = printed.find("vmcost WARNING: timings are uncertain");
    if (busy != std::string::npos)
        printed.erase(busy, printed.find('\n', busy) + 1 - busy);
    EXPECT_EQ(printed, "");
}
