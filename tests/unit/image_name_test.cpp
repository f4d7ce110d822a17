// SPDX-License-Identifier: Apache-2.0
// The names of image files: what can be an output, links, odd names.
#include "temporary_folder.h"
#include "written_images.h"

#include <gtest/gtest.h>

#include <filesystem>

#include <sys/stat.h>
#include <unistd.h>

using namespace vmlight;
using namespace vmlight::written_images;

TEST(ImageName, NamesThatCannotBeOutputsAreRefused)
{
    const TemporaryFolder folder;
    std::string error;
    const auto refusal = [&](const std::string& path) {
        EXPECT_FALSE(write(vismap_like(2, 2), path, error));
        EXPECT_EQ(error, output_fault(path));
        return error;
    };
    EXPECT_EQ(refusal(folder / "a.png"),
              quoted(folder / "a.png") + ": output must be .exr; convert it with oiiotool afterwards");
    EXPECT_EQ(refusal(""), "\"\": output must be .exr; convert it with oiiotool afterwards");
    for (const char* name : { "a.hdr", "A.HDR" })
        EXPECT_EQ(refusal(folder / name),
                  quoted(folder / name)
                      + ": output must be .exr; convert light afterwards: oiiotool x.exr --clamp:min=0 -o x.hdr");
    EXPECT_EQ(refusal(folder / "none/a.exr"),
              quoted(folder / "none/a.exr") + ": no such folder: " + quoted(folder / "none"));
    ASSERT_EQ(::mkdir((folder / "dir.exr").c_str(), 0755), 0);
    EXPECT_EQ(refusal(folder / "dir.exr"), quoted(folder / "dir.exr") + ": is a folder");
    EXPECT_EQ(output_fault("a.exr"), "");
    EXPECT_EQ(output_name_fault(folder / "none/a.exr"), ""); // where it would be is another matter
    EXPECT_EQ(output_name_fault(folder / "a.png"), output_fault(folder / "a.png"));
    EXPECT_EQ(output_fault(folder / "A.EXR"), "");
    if (::geteuid() != 0) { // nothing is forbidden to root
        ASSERT_EQ(::chmod((folder / "dir.exr").c_str(), 0555), 0);
        EXPECT_EQ(refusal(folder / "dir.exr/a.exr"),
                  quoted(folder / "dir.exr/a.exr") + ": folder \"" + folder / "dir.exr"
                      + "\" is not writable: Permission denied");
    }
}

TEST(ImageName, ALinkStaysAndWhatItLeadsToIsWritten)
{
    const TemporaryFolder folder;
    std::string error;
    ASSERT_EQ(::mkdir((folder / "disk").c_str(), 0755), 0);
    ASSERT_TRUE(write(vismap_like(4, 4), folder / "disk/old.exr", error)) << error;
    // Relative and absolute, in one step and in two; to a file and to none yet.
    ASSERT_EQ(::symlink("disk/old.exr", (folder / "old.exr").c_str()), 0);
    ASSERT_EQ(::symlink("old.exr", (folder / "twice.exr").c_str()), 0);
    ASSERT_EQ(::symlink((folder / "disk/new.exr").c_str(), (folder / "dangling.exr").c_str()), 0);
    int width = 8;
    for (const auto& [link, file] : { std::pair("old.exr", "disk/old.exr"),
                                      { "twice.exr", "disk/old.exr" },
                                      { "dangling.exr", "disk/new.exr" } }) {
        EXPECT_TRUE(write(vismap_like(++width, 4), folder / link, error)) << error;
        EXPECT_TRUE(std::filesystem::is_symlink(folder / link)) << link;
        EXPECT_FALSE(std::filesystem::is_symlink(folder / file)) << file;
        EXPECT_EQ(OIIO::ImageInput::open(folder / file)->spec().width, width) << link;
    }
    ASSERT_EQ(::symlink("none/a.exr", (folder / "nowhere.exr").c_str()), 0);
    ASSERT_EQ(::symlink("circle.exr", (folder / "circle.exr").c_str()), 0);
    ASSERT_EQ(::symlink("disk", (folder / "folder.exr").c_str()), 0);
    for (const auto& [link, reason] : { std::pair("nowhere.exr", "no such folder: \"" + folder / "none" + "\""),
                                        { "circle.exr", "too many levels of symbolic links" },
                                        { "folder.exr", "is a folder" } }) {
        EXPECT_FALSE(write(vismap_like(4, 4), folder / link, error));
        EXPECT_EQ(error, quoted(folder / link) + ": " + reason);
        EXPECT_TRUE(std::filesystem::is_symlink(folder / link)) << link;
    }
    EXPECT_EQ(folder.names().size(), 7u); // no debris
}

TEST(ImageName, AnyNameTheFileSystemTakesWorks)
{
    const TemporaryFolder folder;
    std::string error;
    const std::string longest = std::string(251, 'x') + ".exr";
    for (const char* name : { "50%.exr", "%%%%%%%%.exr", "a b.exr", "\xc3\xa4.exr", ".exr", longest.c_str() }) {
        EXPECT_TRUE(write(vismap_like(4, 4), folder / name, error)) << error;
        EXPECT_FALSE(folder.bytes(name).empty()) << name;
    }
    EXPECT_EQ(folder.names().size(), 6u);
    ASSERT_EQ(::mkdir((folder / "100%").c_str(), 0755), 0);
    EXPECT_TRUE(write(vismap_like(4, 4), folder / "100%/a.exr", error)) << error;
}
