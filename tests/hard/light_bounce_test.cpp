// SPDX-License-Identifier: Apache-2.0
// Light that bounces: from where it comes, and what is in its way.
#include "bounced_map.h"
#include "cutout_scene.h"
#include "hard_case.h"
#include "temporary_folder.h"

#include <vmlight/base/format.h>
#include <vmlight/stage/make_stage.h>

#include <OpenImageIO/imagebufalgo.h>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

double mean_of(const std::vector<float>& light)
{
    double sum = 0;
    for (const float value : light)
        sum += double(value);
    return sum / double(light.size());
}

} // namespace

TEST(Light, ACornerThatLightsItself)
{
    HardCase row("A white floor and a white wall that meet at a right angle");
    const int side = 64;
    const Bounced bounced(corner(), {}, bounce_map_of(side));
    const std::vector<float> light = bounced.gather(1);
    // Radiosity of two strips in two dimensions.
    const auto hidden = [](double x) { return 0.5 * (1 - x / std::sqrt(x * x + 1)); };
    double squares = 0, missing = 0, all = 0;
    for (int x = 0; x < side; ++x) {
        const double at = (x % (side / 2) + 0.5) / (side / 2);
        double wanted = 0;
        constexpr int n = 4000;
        for (int i = 0; i < n; ++i) {
            const double h = (i + 0.5) / n;
            wanted += (1 - hidden(h)) * 0.5 * at * h / std::pow(at * at + h * h, 1.5) / n;
        }
        squares += std::pow(double(light[3 * size_t(side / 2 * side + x)]) - wanted, 2);
        missing += wanted;
        all += 1 - hidden(at) + wanted;
    }
    row.naive(format("light from the sky alone: {:.0f} % of it is missing", 100 * missing / all));
    EXPECT_LT(std::sqrt(squares / side), 0.01 * all / side);
    row.ours("within 1 % (RMS) of the radiosity of two strips");
}

TEST(Light, TheBackOfASheet)
{
    HardCase row("A floor under a sheet that is baked too, whose texels are those of its upper side");
    Mesh mesh;
    add_quad(mesh, V3d(-1, -1, 0), V3d(1, -1, 0), V3d(1, 1, 0), V3d(-1, 1, 0), V2f(0, 0), V2f(0.48f, 1));
    add_quad(mesh, V3d(-1, -1, 0.2), V3d(1, -1, 0.2), V3d(1, 1, 0.2), V3d(-1, 1, 0.2), V2f(0.52f, 0), V2f(1, 1));
    const Bounced bounced(mesh, {}, bounce_map_of(64, 32));
    const std::vector<float> light = bounced.gather(1);
    const oracle::Bounce truth({ mesh }, constant_sky, [](size_t) { return 1.0; });
    const std::vector<oracle::Place> places = oracle::places(mesh, 64, 32);
    EXPECT_LT(error_of(light, places, truth, 29), kRmsOfBounce);
    // In the middle of the floor nearly all rays meet the sheet.
    const size_t middle = 16 * 64 + 15;
    EXPECT_LT(light[3 * middle], 0.35f);
    row.naive(format("the floor gets the light of the sheet's upper side: {:.0f} % of the sky, at its middle",
                     std::round(20 * (1 - double(bounced.visibility[middle]))) * 5));
    row.ours("the lower side has its own light: within 8 % of brute force (RMS)");
}

TEST(Light, AHoleThatBouncesPass)
{
    HardCase row("A white wall behind a card that is half holes");
    const auto checker = cutout_scene::texture(
        4, 4, [](int x, int y) { return float((x + y + 1) % 2); }, TextureWrap::clamp, TextureWrap::clamp, true);
    Mesh floor, card;
    add_quad(floor, V3d(0.2, -1, 0), V3d(1, -1, 0), V3d(1, 1, 0), V3d(0.2, 1, 0), V2f(0, 0), V2f(1, 1));
    add_quad(card, V3d(0.2, 20, 0), V3d(0.2, -20, 0), V3d(0.2, -20, 0.8), V3d(0.2, 20, 0.8), V2f(0, 0), V2f(1, 1));
    const Mesh wall = rectangle(V3d(0, -20, 0), V3d(0, 40, 0), V3d(0, 0, 1));
    const auto light_behind = [&](const std::vector<Mesh>& occluders) {
        return mean_of(Bounced(floor, occluders, bounce_map_of(32)).gather(0, [](const LightPoint& point) {
            return point.caster == 0 ? 1.0f : 0.0f;
        }));
    };
    const double open = light_behind({ wall }), shut = light_behind({ wall, card }),
                 half
        = light_behind({ wall, cutout_scene::with_material(card, cutout_scene::material(AlphaMode::mask, checker)) });
    EXPECT_LT(shut, 0.35 * open);
    EXPECT_GT(half, shut + 0.2 * (open - shut));
    EXPECT_LT(half, shut + 0.5 * (open - shut));
    row.naive("a solid card: less than 35 % of the wall's light reaches the floor");
    row.ours("holes pass light on both its ways: 20 to 50 % of what the card holds back");
}

TEST(Light, AShadeThatNoTexelSees)
{
    HardCase row("A lit roof whose shade is below the floor, where no ray of the floor goes");
    // The sky is white below the horizon alone: it lights the roof from below, and that the floor. A cellar is in its
    // way.
    const TemporaryFolder folder;
    folder.write("floor.obj",
                 "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 1 0\n"
                 "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
    folder.write("roof.obj", "v -2 1 2\nv 2 1 2\nv 2 1 -2\nv -2 1 -2\nf 1 2 3 4\n");
    folder.write("cellar.obj", "v -90 -.5 90\nv 90 -.5 90\nv 90 -.5 -90\nv -90 -.5 -90\nf 1 2 3 4\n");
    OIIO::ImageBuf sky(OIIO::ImageSpec(64, 32, 3, OIIO::TypeFloat)), paint(OIIO::ImageSpec(4, 4, 3, OIIO::TypeFloat));
    for (OIIO::ImageBuf::Iterator<float> p(sky); !p.done(); ++p) {
        const float light = p.y() < 16 ? 0.0f : 1.0f;
        p[0] = light, p[1] = light, p[2] = light;
    }
    OIIO::ImageBufAlgo::fill(paint, { 1.0f, 1.0f, 1.0f });
    ASSERT_TRUE(sky.write(folder / "sky.exr") && paint.write(folder / "paint.exr"));
    const auto mean = [&](const std::string& occluders) {
        folder.write("hero.vismap",
                     "mesh = \"floor.obj\"\noccluder = [" + occluders + "]\nresolution = 32\nsamples = 64\n");
        LightmapRecipe recipe;
        recipe.vismap = folder / "hero.vismap";
        recipe.environment = folder / "sky.exr";
        recipe.albedo = folder / "paint.exr";
        recipe.bounce_params.bounce = "auto";
        recipe.bounce_params.bounce_albedo = 1;
        OIIO::ImageBuf lit;
        EXPECT_TRUE(make_image(lit, recipe)) << lit.geterror();
        std::vector<float> light(size_t(lit.spec().image_pixels()) * 3);
        EXPECT_TRUE(lit.get_pixels(lit.roi(), OIIO::TypeFloat, light.data()));
        return mean_of(light);
    };
    const double bright = mean("\"roof.obj\"");
    EXPECT_GT(bright, 0.2);
    EXPECT_LT(mean("\"roof.obj\", \"cellar.obj\""), 0.1 * bright);
    row.naive("left out of the scene as nothing that a texel sees: the floor gets over 20 % of the sky");
    row.ours("what may light texels is traced with all occluders: less than a tenth of that");
}
