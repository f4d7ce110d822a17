// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/source_cache.h>
/// What hosts do to readers: many threads, foreign files, recipes that lead nowhere.
#include "stage_scene.h"
#include <vmlight/stage/source_cache.h>

#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/parallel.h>
#include <vmlight/stage/source_cache.h>

#include <atomic>
#include <random>
#include <thread>
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
using namespace vmlight;
#include <vmlight/stage/source_cache.h>
using namespace stage_scene;
#include <vmlight/stage/source_cache.h>
using OIIO::ImageInput;
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
namespace {
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
std::string error_of_open(const std::string& name)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    OIIO::geterror();
#include <vmlight/stage/source_cache.h>
    return ImageInput::open(name) ? "no error" : OIIO::geterror();
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
} // namespace
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
TEST(StageHost, SixteenThreadsReadRandomTilesThroughAnImageCache)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const Folder folder;
#include <vmlight/stage/source_cache.h>
    const auto fresh = folder / "hero.lightmap?rotate=10,20,30";
#include <vmlight/stage/source_cache.h>
    int64_t covered = 0;
#include <vmlight/stage/source_cache.h>
    {
#include <vmlight/stage/source_cache.h>
        // What one thread gets, and how many tiles it takes; then all of it is forgotten.
#include <vmlight/stage/source_cache.h>
        const Work before;
#include <vmlight/stage/source_cache.h>
        all_pixels(*ImageInput::open(folder / "hero.vismap?seed=1"));
#include <vmlight/stage/source_cache.h>
        covered = (Work() - before).tiles_baked;
#include <vmlight/stage/source_cache.h>
    }
#include <vmlight/stage/source_cache.h>
    const std::vector<float> expected = all_pixels(*ImageInput::open(fresh));
#include <vmlight/stage/source_cache.h>
    set_source_limits(1, 1);
#include <vmlight/stage/source_cache.h>
    folder.write("other.cfem", "environment = \"studio.exr\"\nresolution = 8\n");
#include <vmlight/stage/source_cache.h>
    ImageInput::open(folder / "other.cfem"); // the one source that is kept
#include <vmlight/stage/source_cache.h>
    set_source_limits(size_t(1) << 30, 64);
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
    auto cache = OIIO::ImageCache::create(false);
#include <vmlight/stage/source_cache.h>
    cache->attribute("max_memory_MB", 0.2f); // so that it asks again and again
#include <vmlight/stage/source_cache.h>
    const OIIO::ustring name(fresh);
#include <vmlight/stage/source_cache.h>
    const Work before;
#include <vmlight/stage/source_cache.h>
    std::atomic<int> wrong { 0 };
#include <vmlight/stage/source_cache.h>
    std::vector<std::thread> threads;
#include <vmlight/stage/source_cache.h>
    for (unsigned seed = 0; seed < 16; ++seed)
#include <vmlight/stage/source_cache.h>
        threads.emplace_back([&, seed] {
#include <vmlight/stage/source_cache.h>
            std::mt19937 random(seed);
#include <vmlight/stage/source_cache.h>
            for (int i = 0; i < 60; ++i) {
#include <vmlight/stage/source_cache.h>
                const int x = int(random() % 200), y = int(random() % 150);
#include <vmlight/stage/source_cache.h>
                float rgb[3] = {};
#include <vmlight/stage/source_cache.h>
                const bool good = cache->get_pixels(name, 0, 0, x, x + 1, y, y + 1, 0, 1, OIIO::TypeFloat, rgb);
#include <vmlight/stage/source_cache.h>
                wrong += !good || !std::equal(rgb, rgb + 3, &expected[(size_t(y) * 200 + x) * 3]);
#include <vmlight/stage/source_cache.h>
            }
#include <vmlight/stage/source_cache.h>
        });
#include <vmlight/stage/source_cache.h>
    for (std::thread& thread : threads)
#include <vmlight/stage/source_cache.h>
        thread.join();
#include <vmlight/stage/source_cache.h>
    EXPECT_EQ(wrong, 0) << cache->geterror();
#include <vmlight/stage/source_cache.h>
    const Work work = Work() - before;
#include <vmlight/stage/source_cache.h>
    EXPECT_EQ(work.meshes_read, 1);
#include <vmlight/stage/source_cache.h>
    EXPECT_EQ(work.cfems_made, 1);
#include <vmlight/stage/source_cache.h>
    EXPECT_EQ(work.tiles_baked, covered); // of 12
#include <vmlight/stage/source_cache.h>
    OIIO::ImageCache::destroy(cache);
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
TEST(StageHost, TasksOfTheThreadPoolMayAllWantTheFirstTile)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    for (int run = 0; run < 5; ++run) {
#include <vmlight/stage/source_cache.h>
        const Folder folder;
#include <vmlight/stage/source_cache.h>
        const auto input = ImageInput::open(folder / "hero.lightmap");
#include <vmlight/stage/source_cache.h>
        ASSERT_TRUE(input) << OIIO::geterror();
#include <vmlight/stage/source_cache.h>
        std::atomic<int> good { 0 };
#include <vmlight/stage/source_cache.h>
        const auto read = [&](int64_t i) {
#include <vmlight/stage/source_cache.h>
            std::vector<float> tile(64 * 64 * 3);
#include <vmlight/stage/source_cache.h>
            good += input->read_native_tile(0, 0, int(i % 4) * 64, int(i / 4 % 3) * 64, 0, tile.data());
#include <vmlight/stage/source_cache.h>
        };
#include <vmlight/stage/source_cache.h>
        OIIO::parallel_for(int64_t(0), int64_t(48), read, OIIO::paropt(0, OIIO::paropt::SplitDir::Y, 1));
#include <vmlight/stage/source_cache.h>
        EXPECT_EQ(good, 48) << input->geterror();
#include <vmlight/stage/source_cache.h>
    }
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
TEST(StageHost, ForeignNamesAreRefused)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const Folder folder;
#include <vmlight/stage/source_cache.h>
    folder.write("broken.png", "\x89PNG and no more");
#include <vmlight/stage/source_cache.h>
    folder.write("empty.png", "");
#include <vmlight/stage/source_cache.h>
    for (const char* stage : { "vismap", "cfem", "lightmap" }) {
#include <vmlight/stage/source_cache.h>
        StageInput input(stage);
#include <vmlight/stage/source_cache.h>
        OIIO::ImageSpec spec;
#include <vmlight/stage/source_cache.h>
        for (const char* name : { "broken.png", "empty.png", "spot.obj", "none", "", "hero.lightmap.exr" }) {
#include <vmlight/stage/source_cache.h>
            EXPECT_FALSE(input.valid_file(name));
#include <vmlight/stage/source_cache.h>
            EXPECT_FALSE(input.open(folder / name, spec));
#include <vmlight/stage/source_cache.h>
            EXPECT_NE(input.geterror().find(std::string("not a .") + stage + " recipe"), std::string::npos);
#include <vmlight/stage/source_cache.h>
        }
#include <vmlight/stage/source_cache.h>
        EXPECT_TRUE(input.valid_file(std::string("nowhere/A.") + stage + "?a=b.png"));
#include <vmlight/stage/source_cache.h>
    }
#include <vmlight/stage/source_cache.h>
    EXPECT_NE(error_of_open(folder / "broken.png"), "no error");
#include <vmlight/stage/source_cache.h>
    EXPECT_NE(error_of_open(folder / "empty.png"), "no error");
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
TEST(StageHost, FaultsOfARecipeAreNamed)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const Folder folder;
#include <vmlight/stage/source_cache.h>
    std::string noise(5000, '\0');
#include <vmlight/stage/source_cache.h>
    std::mt19937 random(3);
#include <vmlight/stage/source_cache.h>
    for (char& byte : noise)
#include <vmlight/stage/source_cache.h>
        byte = char(random());
#include <vmlight/stage/source_cache.h>
    folder.write("noise.lightmap", noise);
#include <vmlight/stage/source_cache.h>
    folder.write("empty.lightmap", "");
#include <vmlight/stage/source_cache.h>
    folder.write("comment.vismap", "# nothing is given\n");
#include <vmlight/stage/source_cache.h>
    folder.write("nomesh.vismap", "mesh = \"gone.obj\"\n");
#include <vmlight/stage/source_cache.h>
    folder.write("dark.lightmap", "vismap = \"hero.vismap\"\n");
#include <vmlight/stage/source_cache.h>
    folder.write("both.lightmap", "vismap = \"hero.vismap\"\nenvironment = \"studio.exr\"\ncfem = \"studio.cfem\"\n");
#include <vmlight/stage/source_cache.h>
    folder.write("swapped.lightmap", "vismap = \"studio.cfem\"\nenvironment = \"studio.exr\"\n");
#include <vmlight/stage/source_cache.h>
    folder.write("unlit.lightmap", "vismap = \"hero.vismap\"\ncfem = \"hero.vismap\"\n");
#include <vmlight/stage/source_cache.h>
    std::filesystem::create_directory(folder / "folder.lightmap");
#include <vmlight/stage/source_cache.h>
    for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>> {
#include <vmlight/stage/source_cache.h>
             { "noise.lightmap", "noise.lightmap\"" },
#include <vmlight/stage/source_cache.h>
             { "empty.lightmap", "empty.lightmap\"" },
#include <vmlight/stage/source_cache.h>
             { "folder.lightmap", "folder.lightmap\"" },
#include <vmlight/stage/source_cache.h>
             { "gone.lightmap", "gone.lightmap\"" },
#include <vmlight/stage/source_cache.h>
             { "hero.lightmap?rotate=abc", "rotate: \"abc\"" },
#include <vmlight/stage/source_cache.h>
             { "hero.lightmap?rotation=1,2,3", "unknown parameter \"rotation\"" },
#include <vmlight/stage/source_cache.h>
             { "comment.vismap", "comment.vismap\": mesh is missing" },
#include <vmlight/stage/source_cache.h>
             { "nomesh.vismap", "nomesh.vismap\" line 1: mesh: \"" + (folder / "gone.obj") + "\": no such file" },
#include <vmlight/stage/source_cache.h>
             { "dark.lightmap", "environment is missing, or cfem" },
#include <vmlight/stage/source_cache.h>
             { "both.lightmap", "both.lightmap\" line 3: cfem: environment is given too" },
#include <vmlight/stage/source_cache.h>
             { "swapped.lightmap", "studio.cfem\": is the recipe of a cfem, not of a vismap" },
#include <vmlight/stage/source_cache.h>
             { "unlit.lightmap", "hero.vismap\": is the recipe of a vismap, not of a cfem" } })
#include <vmlight/stage/source_cache.h>
        EXPECT_NE(error_of_open(folder / name).find(text), std::string::npos) << name << ": " << OIIO::geterror();
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
TEST(StageHost, ARecipeThatReadsItselfIsNamedWithTheWholeWay)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const Folder folder;
#include <vmlight/stage/source_cache.h>
    folder.write("self.lightmap", "vismap = \"hero.vismap\"\ncfem = \"studio.cfem\"\nalbedo = \"self.lightmap\"\n");
#include <vmlight/stage/source_cache.h>
    const std::string rest = "vismap = \"hero.vismap\"\ncfem = \"studio.cfem\"\n";
#include <vmlight/stage/source_cache.h>
    folder.write("a.lightmap", rest + "albedo = \"b.lightmap\"\n");
#include <vmlight/stage/source_cache.h>
    folder.write("b.lightmap", rest + "albedo = \"./c.lightmap\"\n");
#include <vmlight/stage/source_cache.h>
    folder.write("c.lightmap", rest + "albedo = \"a.lightmap\"\n");
#include <vmlight/stage/source_cache.h>
    const std::string self = error_of_open(folder / "self.lightmap");
#include <vmlight/stage/source_cache.h>
    EXPECT_NE(self.find("self.lightmap\" reads itself: "), std::string::npos) << self;
#include <vmlight/stage/source_cache.h>
    const std::string ring = error_of_open(folder / "a.lightmap");
#include <vmlight/stage/source_cache.h>
    EXPECT_NE(ring.find("a.lightmap\" reads itself: "), std::string::npos) << ring;
#include <vmlight/stage/source_cache.h>
    const size_t b = ring.find(" -> \"" + (folder / "b.lightmap")), c = ring.find(" -> \"" + (folder / "./c.lightmap"));
#include <vmlight/stage/source_cache.h>
    EXPECT_LT(b, c) << ring;
#include <vmlight/stage/source_cache.h>
    EXPECT_NE(c, std::string::npos) << ring;
#include <vmlight/stage/source_cache.h>
    // Each name differs from the last: a ring that never closes.
#include <vmlight/stage/source_cache.h>
    for (int i = 0; i < 70; ++i)
#include <vmlight/stage/source_cache.h>
        folder.write("deep" + std::to_string(i) + ".lightmap",
#include <vmlight/stage/source_cache.h>
                     rest + "albedo = \"deep" + std::to_string(i + 1) + ".lightmap\"\n");
#include <vmlight/stage/source_cache.h>
    EXPECT_NE(error_of_open(folder / "deep0.lightmap").find("more than 64 nested recipes"), std::string::npos);
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>
