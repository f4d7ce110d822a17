// SPDX-License-Identifier: Apache-2.0
/// Files that appear when they are whole, and folders to write them to.
#include "temporary_folder.h"

#include <vmlight/output_file.h>

#include <gtest/gtest.h>

using namespace vmlight;

TEST(OutputFile, IsThereWithAllItsBytesOrNotAtAll)
{
    const TemporaryFolder folder;
    const std::string path = folder / "text";
    std::string error;
    ASSERT_TRUE(write_file(path, std::string("a\0b", 3), error)) << error;
    EXPECT_EQ(folder.bytes("text"), std::string("a\0b", 3));
    ASSERT_TRUE(write_file(path, "", error)) << error;
    EXPECT_EQ(folder.bytes("text"), "");
    EXPECT_EQ(folder.names(), std::vector<std::string> { "text" });
}

TEST(OutputFile, ThatIsNotKeptLeavesTheOldOne)
{
    const TemporaryFolder folder;
    folder.write("text", "old");
    {
        OutputFile file(folder / "text");
        ASSERT_TRUE(file.sound());
        file.write("new", 3);
        EXPECT_EQ(folder.names().size(), 2u);
    }
    EXPECT_EQ(folder.bytes("text"), "old");
    EXPECT_EQ(folder.names(), std::vector<std::string> { "text" });
}

TEST(OutputFile, ALinkStaysAndWhatItLeadsToIsReplaced)
{
    const TemporaryFolder folder;
    folder.write("target", "old");
    std::filesystem::create_symlink("target", folder / "link");
    std::string error;
    ASSERT_TRUE(write_file(folder / "link", "new", error)) << error;
    EXPECT_EQ(folder.bytes("target"), "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
}

TEST(OutputFile, SaysWhyAPlaceWillNotDo)
{
    const TemporaryFolder folder;
    const std::string file = folder.write("file", "");
    std::string error;
    EXPECT_FALSE(write_file(folder / "no/file", "x", error));
    EXPECT_EQ(error, "\"" + (folder / "no/file") + "\": no folder \"" + (folder / "no") + "\"");
    EXPECT_FALSE(write_file("/dev/null", "x", error));
    EXPECT_EQ(error, "\"/dev/null\": is a device or a pipe, which a file would replace");
    EXPECT_EQ(output_folder_fault(file), "\"" + file + "\": is a file, not a folder");
    EXPECT_EQ(output_folder_fault(folder / ""), "");
    EXPECT_EQ(output_folder_fault(folder / "new"), "");
    EXPECT_EQ(output_folder_fault(folder / "new/"), "");
    EXPECT_NE(output_folder_fault(folder / "no/new"), "");
    EXPECT_NE(output_folder_fault("/proc").find("cannot be written"), std::string::npos);
    EXPECT_EQ(folder.names(), std::vector<std::string> { "file" }) << "asking leaves nothing";
}
