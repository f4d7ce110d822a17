// SPDX-License-Identifier: Apache-2.0
// Changes of files: which are seen.
#include "temporary_folder.h"

#include <vmlight/base/file_watch.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

using namespace vmlight;
namespace fs = std::filesystem;

namespace {

void put_text(const fs::path& path, const std::string& text)
{
    std::ofstream(path) << text;
}

} // namespace

// Each wait() would last for ever if its change were not seen.
TEST(FileWatch, SeesEachWayToChangeAFile)
{
    if (!FileWatch::fault().empty())
        GTEST_SKIP() << FileWatch::fault();
    const TemporaryFolder folder;
    const fs::path root(folder / ""), file = root / "in" / "a";
    fs::create_directory(root / "in");
    put_text(file, "1");
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
    put_text(file, "22");
    seen();
    put_text(root / "in" / "new", "333");
    fs::rename(root / "in" / "new", file);
    seen();
    fs::permissions(file, fs::perms::group_write, fs::perm_options::add);
    seen();
    fs::remove(file);
    seen();
    fs::create_directory(root / "other");
    fs::remove(root / "link");
    fs::create_symlink("other", root / "link");
    seen();
    put_text(root / "other" / "a", "4444");
    seen();
    fs::create_directory(root / "later");
    seen();
    put_text(root / "later" / "b", "1");
    seen();
    fs::remove_all(root / "later");
    seen();
}
