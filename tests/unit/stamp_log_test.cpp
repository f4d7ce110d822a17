// SPDX-License-Identifier: Apache-2.0
/// Files that were read are noted.
#include "temporary_folder.h"

#include <vmlight/base/file_stamp.h>

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
