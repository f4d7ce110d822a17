// SPDX-License-Identifier: Apache-2.0
/// What texture filters make of a visibility map: averages of blocks of texels, of which some lie outside the island.
#include "baked_map.h"
#include "scenes.h"

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

constexpr int kMipSide = 128;

// The worst error, against an open floor, of the mips' texels at `level` that touch the island.
double worst_error(int margin, int level)
{
    Mesh floor = floor_facing_z(1);
    for (V2f& uv : floor.uvs)
        uv = V2f(0.2f, 0.3f) + uv * 0.4f; // its border meets no border of a block
    VismapParams params = map_params(kMipSide, kMipSide, 4, "fibonacci");
    params.margin = margin;
    params.channels = { "coverage" };
    OIIO::ImageBuf map;
    EXPECT_TRUE(make_vismap(map, floor, {}, params)) << map.geterror();
    const int block = 1 << level;
    double worst = 0;
    for (int top = 0; top < kMipSide; top += block)
        for (int left = 0; left < kMipSide; left += block) {
            double sum[5] = {};
            for (int y = top; y < top + block; ++y)
                for (int x = left; x < left + block; ++x) {
                    float texel[5];
                    map.getpixel(x, y, texel, 5);
                    for (int c = 0; c < 5; ++c)
                        sum[c] += double(texel[c]) / (block * block);
                }
            if (sum[4] == 0) // nothing is covered
                continue;
            worst = std::max(
                { worst, std::abs(sum[0] - 1), std::abs(sum[1]), std::abs(sum[2]), std::abs(sum[3] - 2.0 / 3) });
        }
    return worst;
}

} // namespace

// A block of 2^k texels that touches the island reaches less than 2^k texels out of it.
TEST(VismapMips, AMarginAsWideAsABlockKeepsTheBackgroundOut)
{
    for (int level = 1; level <= 4; ++level) {
        EXPECT_LT(worst_error(16, level), 1e-6) << level;
        EXPECT_LT(worst_error((1 << level) - 1, level), 1e-6) << level;
        EXPECT_GT(worst_error(0, level), 0.2) << level;
    }
    EXPECT_GT(worst_error(16, 6), 0.2);
}
