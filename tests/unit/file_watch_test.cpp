// SPDX-License-Identifier: Apache-2.0
/// Changes of files: which are seen, and that what was read is noted.
#include "temporary_folder.h"

#include <vmlight/base/file_stamp.h>
#include <vmlight/base/file_watch.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

using namespace vmlight;
namespace fs = std::filesystem;

namespace {

void put(const fs::path& path, const std::string& text)
{
    std::ofstream(path) << text;
}

} // namespace

TEST(StampLog, NotesWhatIsReadWhileItExists)
{
    const TemporaryFolder folder;
    const std::string file = folder / "a", gone = folder / "gone";
    put(file, "1");
    std::string stamp, error;
    {
        const StampLog log;
        ASSERT_TRUE(stamp_file(stamp, file, error));
        const std::string first = stamp;
        EXPECT_FALSE(stamp_file(stamp, gone, error));
        put(file, "22");
        ASSERT_TRUE(stamp_file(stamp, file, error));
        log_file(folder / "b");
        const std::vector<FileStamp> files = StampLog::files();
        ASSERT_EQ(files.size(), 3u);
        EXPECT_EQ(files[0].path, file);
        EXPECT_EQ(files[0].stamp, first) << "of when it was read first: the file has changed since";
        EXPECT_NE(stamp, first);
        EXPECT_EQ(files[2].path, gone);
        EXPECT_EQ(files[2].stamp, "");
        StampLog::clear();
        EXPECT_TRUE(StampLog::files().empty());
    }
    ASSERT_TRUE(stamp_file(stamp, file, error));
    EXPECT_TRUE(StampLog::files().empty());
}

// Each wait() would last for ever if its change were not seen.
TEST(FileWatch, SeesEachWayToChangeAFile)
{
    if (!FileWatch::fault().empty())
        GTEST_SKIP() << FileWatch::fault();
    const TemporaryFolder folder;
    const fs::path root(folder / ""), file = root / "in" / "a";
    fs::create_directory(root / "in");
    put(file, "1");
    fs::create_symlink("in", root / "link");
    const std::vector<std::string> paths { (root / "link" / "a").string(), (root / "later" / "b").string(),
                                           file.string() + "?query=1" };
    FileWatch watch;
    std::string error;
    const auto seen = [&] {
        watch.wait();
        EXPECT_TRUE(watch.follow(paths, error)) << error;
    };
    ASSERT_TRUE(watch.follow(paths, error)) << error;
    put(file, "22");
    seen();
    put(root / "in" / "new", "333");
    fs::rename(root / "in" / "new", file);
    seen();
    fs::last_write_time(file, fs::file_time_type::clock::now());
    seen();
    fs::remove(file);
    seen();
    fs::create_directory(root / "other");
    fs::remove(root / "link");
    fs::create_symlink("other", root / "link");
    seen();
    put(root / "other" / "a", "4444");
    seen();
    fs::create_directory(root / "later");
    seen();
    put(root / "later" / "b", "1");
    seen();
    fs::remove_all(root / "later");
    seen();
}
