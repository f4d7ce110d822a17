// SPDX-License-Identifier: Apache-2.0
/// Recipes as a renderer's textures.
#include <OpenImageIO/Imath.h> // before texture.h, which else brings placeholders of its own

#include "stage_scene.h"

#include <OpenImageIO/texture.h>

#include <array>
#include <atomic>
#include <random>
#include <thread>

using namespace vmlight;
using namespace stage_scene;

namespace {

using LookedUp = std::array<float, 3>;

struct Lookup
{
    float s, t, width;
};

std::vector<Lookup> random_lookups(unsigned seed, int count)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<Lookup> lookups;
    for (int i = 0; i < count; ++i)
        lookups.push_back({ unit(random), unit(random), i % 3 ? 0.002f : 0.05f });
    return lookups;
}

template <class System> bool look(System& system, const std::string& name, const Lookup& at, LookedUp& color)
{
    OIIO::TextureOpt options;
    return system->texture(OIIO::ustring(name), options, at.s, at.t, at.width, 0, 0, at.width, 3, color.data());
}

} // namespace

TEST(StageTexture, SixteenThreadsOfARendererSeeWhatAFileWouldShow)
{
    const Folder folder;
    const std::string live = folder / "hero.lightmap?exposure=0.5", stored = folder / "lit.exr";
    {
        OIIO::ImageBuf image(live);
        image.set_write_tiles(64, 64); // as the reader's: the filter depends on nothing else
        ASSERT_TRUE(image.write(stored)) << image.geterror();
    }
    auto system = OIIO::TextureSystem::create(false);
    const Work before;
    std::atomic<int> wrong { 0 }, failed { 0 };
    std::vector<std::thread> threads;
    for (unsigned seed = 0; seed < 16; ++seed)
        threads.emplace_back([&, seed] {
            for (const Lookup& at : random_lookups(seed, 200)) {
                LookedUp a {}, b {};
                const bool good = look(system, live, at, a) && look(system, stored, at, b);
                failed += !good;
                wrong += a != b;
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(failed, 0) << system->geterror();
    EXPECT_EQ(wrong, 0);
    const Work work = Work() - before;
    EXPECT_EQ(work.meshes_read, 0) << "what was read to be stored is still there";
    EXPECT_EQ(work.cfems_made, 0);
    EXPECT_EQ(work.tiles_baked, 0);
    OIIO::TextureSystem::destroy(system, true);
}

TEST(StageTexture, ABrokenRecipeIsAFailedLookupThatNamesIt)
{
    const Folder folder;
    folder.write("broken.lightmap", "vismap = \"gone.vismap\"\ncfem = \"studio.cfem\"\n");
    auto system = OIIO::TextureSystem::create(false);
    LookedUp color {};
    EXPECT_FALSE(look(system, folder / "broken.lightmap", { 0.5f, 0.5f, 0.01f }, color));
    EXPECT_NE(system->geterror().find("broken.lightmap\" line 1: vismap: "), std::string::npos);
    OIIO::TextureSystem::destroy(system, true);
}
