// SPDX-License-Identifier: Apache-2.0
// What runs leave behind: outputs that cannot be written, failures, and the same bytes again.
#include "command_test.h"

#include <OpenImageIO/imageio.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include <csignal>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

using namespace vmlight;
using testing::HasSubstr;

namespace {

class Outputs : public CommandTest
{
protected:
    void SetUp() override
    {
        make_vismap();
        write("old.exr", "the old picture");
    }
};

} // namespace

TEST_F(Outputs, ANameThatCannotBeWrittenIsRefusedBeforeTheWork)
{
    refused(2, "\"x.png\": output must be .exr", "makevismap quad.obj -o x.png");
    refused(2, "\"x.hdr\": output must be .exr; convert light afterwards: oiiotool x.exr --clamp:min=0 -o x.hdr",
            "makelightmap vm.exr gone.exr -o x.hdr");
    refused(1, "no such folder: \"missing\"", "makevismap quad.obj -o missing/x.exr");
    if (std::filesystem::is_directory("/proc")) // takes no files, though root may write to it
        refused(1, "\"/proc/x.exr\": folder \"/proc\" is not writable: ", "makevismap gone.obj -o /proc/x.exr");
    std::filesystem::create_directory("folder.exr");
    refused(1, "\"folder.exr\": is a folder", "makevismap quad.obj -o folder.exr");
    std::filesystem::create_directory("pipes");
    ASSERT_EQ(::mkfifo("pipes/x.exr", 0600), 0);
    refused(1, "is a device or a pipe", "makevismap quad.obj -o pipes/x.exr");
    if (::geteuid() != 0) {
        ASSERT_EQ(::mkdir("locked", 0500), 0);
        refused(1, "is not writable", "makevismap quad.obj -o locked/x.exr");
    }
}

TEST_F(Outputs, AFailedRunLeavesTheOldFile)
{
    write("bad.obj", kQuadWithoutUv);
    refused(1, "no texture coordinates", "makevismap bad.obj -o old.exr");
    refused(1, "no such file", "makecfem missing.exr -o old.exr");
    refused(1, "no such file", "makelightmap vm.exr missing.exr -o old.exr");
}

TEST_F(Outputs, AFullDiskIsReportedAndLeavesTheOldFile)
{
    rlimit before;
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    // The run ignores SIGXFSZ, which would end the process.
    const rlimit full { 100000, before.rlim_max };
    const auto old = contents();
    for (const std::string threads : { "1", "4" }) {
        ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &full), 0);
        const Result result = run("makevismap {spot} -o old.exr --resolution 512 --samples 4 --threads " + threads);
        ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
        EXPECT_EQ(result.code, 1);
        EXPECT_THAT(result.err, HasSubstr("makevismap ERROR: \"old.exr\": File too large"));
        EXPECT_TRUE(contents() == old);
    }
}

TEST_F(Outputs, HalfIsRefusedWhereItWouldOverflow)
{
    make_sky({ 1e5f, 1, 1 });
    refused(1, "the maximum of half is 65504", "makecfem sky.exr -o old.exr --format half");
    done("makecfem sky.exr -o old.exr");
}

// Babylon.js cannot open tiles or parts; three.js and it read channels of several types as garbage.
TEST_F(Outputs, LightmapsAreWhatEveryLoaderReads)
{
    make_sky({ 0.25f, 0.5f, 2 });
    done("makecfem {sky} --stack -o stack.exr"); // of several parts
    done("makevismap quad.obj -o sh.exr --resolution 70x66 --samples 4 --basis sh --channels normal");
    done("makelightmap sh.exr sky.exr -o lit_float.exr");
    done("makelightmap sh.exr stack.exr -o lit_half.exr --format half");
    done("makelightmap vm.exr sky.exr --albedo sky.exr -o lit_albedo.exr");
    done("makelightmap vm.exr stack.exr -o lit.####.exr --frames 1-2 --rotate-y 0:90");
    done("makelightmap vm.exr sky.exr -o lit_tile.<UDIM>.exr --udims 1001");
    const auto lightmaps = names("lit");
    ASSERT_EQ(lightmaps.size(), 6u);
    for (const std::string& name : lightmaps) {
        // The magic number, then version 2 without the bits for tiles, long names, deep data and parts.
        EXPECT_EQ(read(name).substr(0, 8), std::string("\x76\x2f\x31\x01\x02\0\0\0", 8)) << name;
        const auto in = OIIO::ImageInput::open(path(name));
        ASSERT_TRUE(in) << name << ": " << OIIO::geterror();
        const OIIO::ImageSpec& spec = in->spec();
        EXPECT_EQ(spec.tile_width, 0) << name;
        EXPECT_EQ(spec.channelnames, (std::vector<std::string> { "R", "G", "B" })) << name;
        EXPECT_TRUE(spec.channelformats.empty()) << name;
        EXPECT_EQ(spec.format, name == "lit_half.exr" ? OIIO::TypeHalf : OIIO::TypeFloat) << name;
        EXPECT_EQ(spec.roi(), spec.roi_full()) << name;
        EXPECT_EQ(std::pair(spec.x, spec.y), std::pair(0, 0)) << name;
        EXPECT_EQ(spec.get_string_attribute("compression"), "zip") << name;
        EXPECT_FALSE(in->seek_subimage(1, 0)) << name;
    }
}

TEST_F(Outputs, SameInputsGiveTheSameBytesForAnyNumberOfThreads)
{
    for (const std::string threads : { "1", "2", "7" }) {
        const std::string end = threads + ".exr --threads " + threads;
        done("makevismap {spot} --resolution 128 --samples 16 -o vm" + end);
        done("makecfem {sky} -o cfem" + end);
        done("makelightmap vm" + threads + ".exr cfem" + threads + ".exr -o lit" + end);
        if (threads == "1") // a date in the file would differ now
            std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    }
    for (const std::string stage : { "vm", "cfem", "lit" }) {
        EXPECT_TRUE(read(stage + "1.exr") == read(stage + "2.exr")) << stage;
        EXPECT_TRUE(read(stage + "1.exr") == read(stage + "7.exr")) << stage;
    }
    for (const std::string& word : { path(""), std::string("makevismap"), std::string("--resolution") })
        EXPECT_EQ(read("vm1.exr").find(word), std::string::npos) << word;
}
