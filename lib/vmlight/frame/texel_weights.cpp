// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/texel_weights.h>

#include <vmlight/base/parallel.h>
#include <vmlight/image/channels.h>
#include <vmlight/uv/raster.h>

#include <array>
#include <memory>

namespace vmlight {
namespace {

constexpr float kMarginWeight = 1.0f / (1 << 20);

} // namespace

std::vector<float> texel_weights(const Mesh& mesh, const OIIO::ImageBuf& vismap, int udim, int nthreads)
{
    const OIIO::ImageSpec& spec = vismap.spec();
    const int width = spec.width, height = spec.height;
    std::vector<float> weights(size_t(width) * size_t(height));
    std::array<int, 4> index;
    std::string ignored; // who lights the map refuses it
    if (find_vismap_channels(spec, index, ignored) && vismap.localpixels()) {
        const auto* pixels = static_cast<const float*>(vismap.localpixels());
        for (size_t texel = 0; texel < weights.size(); ++texel)
            for (const int channel : index)
                if (pixels[texel * size_t(spec.nchannels) + size_t(channel)] != 0)
                    weights[texel] = kMarginWeight;
    }
    const UvRaster raster(mesh, width, height, udim);
    const int across = raster.tiles_across();
    parallel_items(int64_t(across) * raster.tiles_down(), nthreads, [&](int64_t tile, int) {
        const auto cover = std::make_unique<TileCover>();
        raster.cover(int(tile), *cover);
        const int left = int(tile % across) * kTileSize, top = int(tile / across) * kTileSize;
        for (int y = top; y < std::min(top + kTileSize, height); ++y)
            for (int x = left; x < std::min(left + kTileSize, width); ++x)
                if (cover->triangle[size_t(y - top) * kTileSize + size_t(x - left)] != TileCover::kNone)
                    weights[size_t(y) * size_t(width) + size_t(x)] = 1;
    });
    return weights;
}

} // namespace vmlight
