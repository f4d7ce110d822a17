// SPDX-License-Identifier: Apache-2.0
/// Files that appear when they are whole, and folders to write them to.
#include "temporary_folder.h"

#include <vmlight/base/output_file.h>

#include <gtest/gtest.h>

#include <csignal>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace vmlight;

namespace {

mode_t rights_of(const std::string& path)
{
    struct stat status
    { };
    EXPECT_EQ(::stat(path.c_str(), &status), 0);
    return status.st_mode & 07777;
}

bool put(const std::string& path, const std::string& bytes, TemporaryFileKind kind)
{
    OutputFile file(path, kind);
    file.write(bytes.data(), bytes.size());
    return file.commit();
}

// A process that has written half of `path` when it is killed.
void die_writing(const std::string& path, TemporaryFileKind kind)
{
    const pid_t child = ::fork();
    if (child == 0) {
        OutputFile file(path, kind);
        file.write("half", 4);
        ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
}

} // namespace

class OutputFileOf : public testing::TestWithParam<TemporaryFileKind>
{ };
INSTANTIATE_TEST_SUITE_P(Kinds, OutputFileOf, testing::Values(TemporaryFileKind::Unnamed, TemporaryFileKind::Hidden));

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

TEST_P(OutputFileOf, WhatIsNotKeptLeavesTheOldOne)
{
    const TemporaryFolder folder;
    folder.write("text", "old");
    {
        OutputFile file(folder / "text", GetParam());
        ASSERT_TRUE(file.ok());
        file.write("new", 3);
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
    EXPECT_EQ(error, "\"" + (folder / "no/file") + "\": no such folder: \"" + (folder / "no") + "\"");
    EXPECT_FALSE(write_file(folder / "file/x", "x", error));
    EXPECT_EQ(error, "\"" + (folder / "file/x") + "\": no such folder: \"" + file + "\"");
    EXPECT_FALSE(write_file("/dev/null", "x", error));
    EXPECT_EQ(error, "\"/dev/null\": is a device or a pipe, not a file");
    EXPECT_EQ(output_folder_fault(file), "\"" + file + "\": is a file, not a folder");
    EXPECT_EQ(output_folder_fault(folder / ""), "");
    EXPECT_EQ(output_folder_fault(folder / "new"), "");
    EXPECT_EQ(output_folder_fault(folder / "new/"), "");
    EXPECT_NE(output_folder_fault(folder / "no/new"), "");
    EXPECT_NE(output_folder_fault("/proc").find("is not writable"), std::string::npos);
    EXPECT_EQ(folder.names(), std::vector<std::string> { "file" }) << "asking leaves nothing";
}

TEST_P(OutputFileOf, HasTheRightsOfAnyNewFileOrOfTheOldOne)
{
    const TemporaryFolder folder;
    const mode_t mask = ::umask(027);
    EXPECT_TRUE(put(folder / "new", "x", GetParam()));
    ::umask(mask);
    EXPECT_EQ(rights_of(folder / "new"), 0640u);
    folder.write("secret", "old");
    ::chmod((folder / "secret").c_str(), 0600);
    EXPECT_TRUE(put(folder / "secret", "new", GetParam()));
    EXPECT_EQ(folder.bytes("secret"), "new");
    EXPECT_EQ(rights_of(folder / "secret"), 0600u);
}

TEST_P(OutputFileOf, AnotherNameOfTheOldOneKeepsIt)
{
    const TemporaryFolder folder;
    folder.write("text", "old");
    std::filesystem::create_hard_link(folder / "text", folder / "other");
    EXPECT_TRUE(put(folder / "text", "new", GetParam()));
    EXPECT_EQ(folder.bytes("text"), "new");
    EXPECT_EQ(folder.bytes("other"), "old");
}

TEST_P(OutputFileOf, NamesMayBeAsLongAsAFileSystemTakes)
{
    const TemporaryFolder folder;
    for (const std::string& letter : { std::string("a"), std::string("\u00e4"), std::string("\u20ac") }) {
        std::string name;
        while (name.size() + letter.size() <= 255)
            name += letter;
        std::string error;
        EXPECT_EQ(output_file_fault(folder / name), "");
        EXPECT_TRUE(put(folder / name, "old", GetParam()));
        EXPECT_TRUE(put(folder / name, "new", GetParam()));
        EXPECT_EQ(folder.bytes(name), "new");
        const std::string longer = name + "abc";
        EXPECT_EQ(output_file_fault(folder / longer), "\"" + (folder / longer) + "\": File name too long");
    }
    EXPECT_EQ(folder.names().size(), 3u);
}

TEST(OutputFile, OfAKilledProcessIsGoneAtOnceOrWithTheNextRun)
{
    const TemporaryFolder folder;
    folder.write("text", "old");
    die_writing(folder / "text", TemporaryFileKind::Unnamed);
    EXPECT_EQ(folder.names(), std::vector<std::string> { "text" });

    die_writing(folder / "text", TemporaryFileKind::Hidden);
    ASSERT_EQ(folder.names().size(), 2u);
    EXPECT_EQ(folder.bytes("text"), "old");
    std::string error;
    ASSERT_TRUE(write_file(folder / "text", "new", error)) << error;
    EXPECT_EQ(folder.names(), std::vector<std::string> { "text" });
    EXPECT_EQ(folder.bytes("text"), "new");
}

TEST(OutputFile, RemovesNoFileThatMayBeAnothers)
{
    const TemporaryFolder folder;
    // Almost the name of a part, or that of another file.
    const std::vector<std::string> strangers {
        ".text.0123456.part",   ".text.01234567.par", ".text.0123456g.part", ".text.012345678.part",
        ".text2.01234567.part", "text.01234567.part", ".text.part"
    };
    for (const std::string& name : strangers)
        folder.write(name, "");
    std::filesystem::create_symlink(".text.part", folder / ".text.00000000.part");
    std::filesystem::create_directory(folder / ".text.11111111.part");
    OutputFile living(folder / "text", TemporaryFileKind::Hidden);
    living.write("one", 3);
    EXPECT_TRUE(put(folder / "text", "two", TemporaryFileKind::Hidden));
    EXPECT_EQ(folder.names().size(), strangers.size() + 4);
    ASSERT_TRUE(living.commit());
    EXPECT_EQ(folder.bytes("text"), "one");
    EXPECT_EQ(folder.names().size(), strangers.size() + 3);
}

TEST_P(OutputFileOf, IsWrittenInAnyOrderAndReadBack)
{
    const TemporaryFolder folder;
    OutputFile file(folder / "text", GetParam());
    EXPECT_EQ(file.write("0123456789", 10), 10u);
    EXPECT_TRUE(file.seek(2));
    EXPECT_EQ(file.write("ab", 2), 2u);
    EXPECT_EQ(file.tell(), 4);
    EXPECT_EQ(file.pwrite("z", 1, 12), 1u); // beyond the end: the gap is zeros
    EXPECT_EQ(file.tell(), 4);
    EXPECT_EQ(file.size(), 13u);
    char bytes[20] = {};
    EXPECT_EQ(file.read(bytes, 3), 3u);
    EXPECT_STREQ(bytes, "456");
    EXPECT_EQ(file.pread(bytes, sizeof(bytes), 0), 13u);
    file.flush();
    file.close();
    ASSERT_TRUE(file.commit()) << file.reason();
    EXPECT_EQ(folder.bytes("text"), std::string("01ab456789\0\0z", 13));
}

TEST_P(OutputFileOf, OneFailureIsRememberedWhateverComesAfter)
{
    const TemporaryFolder folder;
    folder.write("text", "old");
    for (const std::string what : { "seek", "read", "length" }) {
        OutputFile file(folder / "text", GetParam());
        file.write("new", 3);
        if (what == "seek") {
            EXPECT_TRUE(file.seek(-1)) << "no call reports a failure";
        } else if (what == "read") {
            EXPECT_EQ(file.pread(nullptr, 3, 0), 0u);
        }
        EXPECT_EQ(file.ok(), what == "length");
        EXPECT_EQ(file.write("more", 4), 4u);
        if (what == "length") {
            EXPECT_EQ(::truncate(file.temporary_path().c_str(), 2), 0);
        }
        EXPECT_FALSE(file.commit());
        EXPECT_NE(file.reason(), "");
        EXPECT_EQ(folder.bytes("text"), "old") << what;
    }
    EXPECT_EQ(folder.names(), std::vector<std::string> { "text" });
}
