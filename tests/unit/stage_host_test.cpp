// SPDX-License-Identifier: Apache-2.0
/// What hosts do to readers: many threads, foreign files, recipes that lead nowhere.
#include "stage_scene.h"

#include <vmlight/stage/source_cache.h>

#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/parallel.h>

#include <atomic>
#include <random>
#include <thread>

using namespace vmlight;
using namespace stage_scene;
using OIIO::ImageInput;

namespace {

std::string error_of_open(const std::string& name)
{
    OIIO::geterror();
    return ImageInput::open(name) ? "no error" : OIIO::geterror();
}

} // namespace

TEST(StageHost, SixteenThreadsReadRandomTilesThroughAnImageCache)
{
    const Folder folder;
    const auto fresh = folder / "hero.lightmap?rotate=10,20,30";
    int64_t covered = 0;
    {
        // What one thread gets, and how many tiles it takes; then all of it is forgotten.
        const Work before;
        all_pixels(*ImageInput::open(folder / "hero.vismap?seed=1"));
        covered = (Work() - before).tiles_baked;
    }
    const std::vector<float> expected = all_pixels(*ImageInput::open(fresh));
    set_source_limits(1, 1);
    folder.write("other.cfem", "environment = \"studio.exr\"\nresolution = 8\n");
    ImageInput::open(folder / "other.cfem"); // the one source that is kept
    set_source_limits(size_t(1) << 30, 64);

    auto cache = OIIO::ImageCache::create(false);
    cache->attribute("max_memory_MB", 0.2f); // so that it asks again and again
    const OIIO::ustring name(fresh);
    const Work before;
    std::atomic<int> wrong { 0 };
    std::vector<std::thread> threads;
    for (unsigned seed = 0; seed < 16; ++seed)
        threads.emplace_back([&, seed] {
            std::mt19937 random(seed);
            for (int i = 0; i < 60; ++i) {
                const int x = int(random() % 200), y = int(random() % 150);
                float rgb[3] = {};
                const bool good = cache->get_pixels(name, 0, 0, x, x + 1, y, y + 1, 0, 1, OIIO::TypeFloat, rgb);
                wrong += !good || !std::equal(rgb, rgb + 3, &expected[(size_t(y) * 200 + x) * 3]);
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(wrong, 0) << cache->geterror();
    const Work work = Work() - before;
    EXPECT_EQ(work.meshes_read, 1);
    EXPECT_EQ(work.cfems_made, 1);
    EXPECT_EQ(work.tiles_baked, covered); // of 12
    OIIO::ImageCache::destroy(cache);
}

TEST(StageHost, TasksOfTheThreadPoolMayAllWantTheFirstTile)
{
    for (int run = 0; run < 5; ++run) {
        const Folder folder;
        const auto input = ImageInput::open(folder / "hero.lightmap");
        ASSERT_TRUE(input) << OIIO::geterror();
        std::atomic<int> good { 0 };
        const auto read = [&](int64_t i) {
            std::vector<float> tile(64 * 64 * 3);
            good += input->read_native_tile(0, 0, int(i % 4) * 64, int(i / 4 % 3) * 64, 0, tile.data());
        };
        OIIO::parallel_for(int64_t(0), int64_t(48), read, OIIO::paropt(0, OIIO::paropt::SplitDir::Y, 1));
        EXPECT_EQ(good, 48) << input->geterror();
    }
}

TEST(StageHost, ForeignNamesAreRefused)
{
    const Folder folder;
    folder.write("broken.png", "\x89PNG and no more");
    folder.write("empty.png", "");
    for (const char* stage : { "vismap", "cfem", "lightmap" }) {
        StageInput input(stage);
        OIIO::ImageSpec spec;
        for (const char* name : { "broken.png", "empty.png", "spot.obj", "none", "", "hero.lightmap.exr" }) {
            EXPECT_FALSE(input.valid_file(name));
            EXPECT_FALSE(input.open(folder / name, spec));
            EXPECT_NE(input.geterror().find(std::string("not a .") + stage + " recipe"), std::string::npos);
        }
        EXPECT_TRUE(input.valid_file(std::string("nowhere/A.") + stage + "?a=b.png"));
    }
    EXPECT_NE(error_of_open(folder / "broken.png"), "no error");
    EXPECT_NE(error_of_open(folder / "empty.png"), "no error");
}

TEST(StageHost, FaultsOfARecipeAreNamed)
{
    const Folder folder;
    std::string noise(5000, '\0');
    std::mt19937 random(3);
    for (char& byte : noise)
        byte = char(random());
    folder.write("noise.lightmap", noise);
    folder.write("empty.lightmap", "");
    folder.write("comment.vismap", "# nothing is given\n");
    folder.write("nomesh.vismap", "mesh = \"gone.obj\"\n");
    folder.write("dark.lightmap", "vismap = \"hero.vismap\"\n");
    folder.write("both.lightmap", "vismap = \"hero.vismap\"\nenvironment = \"studio.exr\"\ncfem = \"studio.cfem\"\n");
    folder.write("swapped.lightmap", "vismap = \"studio.cfem\"\nenvironment = \"studio.exr\"\n");
    folder.write("unlit.lightmap", "vismap = \"hero.vismap\"\ncfem = \"hero.vismap\"\n");
    std::filesystem::create_directory(folder / "folder.lightmap");
    for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>> {
             { "noise.lightmap", "noise.lightmap\"" },
             { "empty.lightmap", "empty.lightmap\"" },
             { "folder.lightmap", "folder.lightmap\"" },
             { "gone.lightmap", "gone.lightmap\"" },
             { "hero.lightmap?rotate=abc", "rotate: \"abc\"" },
             { "hero.lightmap?rotation=1,2,3", "unknown parameter \"rotation\"" },
             { "comment.vismap", "comment.vismap\": mesh is missing" },
             { "nomesh.vismap", "nomesh.vismap\" line 1: mesh: \"" + (folder / "gone.obj") + "\": no such file" },
             { "dark.lightmap", "environment or cfem is missing" },
             { "both.lightmap", "both.lightmap\" line 3: cfem: environment is set too" },
             { "swapped.lightmap", "studio.cfem\": is the recipe of a cfem, not of a vismap" },
             { "unlit.lightmap", "hero.vismap\": is the recipe of a vismap, not of a cfem" } })
        EXPECT_NE(error_of_open(folder / name).find(text), std::string::npos) << name << ": " << OIIO::geterror();
}

TEST(StageHost, ARecipeThatReadsItselfIsNamedWithTheWholeWay)
{
    const Folder folder;
    folder.write("self.lightmap", "vismap = \"hero.vismap\"\ncfem = \"studio.cfem\"\nalbedo = \"self.lightmap\"\n");
    const std::string rest = "vismap = \"hero.vismap\"\ncfem = \"studio.cfem\"\n";
    folder.write("a.lightmap", rest + "albedo = \"b.lightmap\"\n");
    folder.write("b.lightmap", rest + "albedo = \"./c.lightmap\"\n");
    folder.write("c.lightmap", rest + "albedo = \"a.lightmap\"\n");
    const std::string self = error_of_open(folder / "self.lightmap");
    EXPECT_NE(self.find("self.lightmap\" reads itself: "), std::string::npos) << self;
    const std::string ring = error_of_open(folder / "a.lightmap");
    EXPECT_NE(ring.find("a.lightmap\" reads itself: "), std::string::npos) << ring;
    const size_t b = ring.find(" -> \"" + (folder / "b.lightmap")), c = ring.find(" -> \"" + (folder / "./c.lightmap"));
    EXPECT_LT(b, c) << ring;
    EXPECT_NE(c, std::string::npos) << ring;
    // Each name differs from the last: a ring that never closes.
    for (int i = 0; i < 70; ++i)
        folder.write("deep" + std::to_string(i) + ".lightmap",
                     rest + "albedo = \"deep" + std::to_string(i + 1) + ".lightmap\"\n");
    EXPECT_NE(error_of_open(folder / "deep0.lightmap").find("more than 64 nested recipes"), std::string::npos);
}
