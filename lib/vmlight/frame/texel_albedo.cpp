// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/texel_albedo.h>

#include <vmlight/base/parallel.h>
#include <vmlight/frame/layers.h>
#include <vmlight/frame/surface_color.h>
#include <vmlight/image/channels.h>
#include <vmlight/uv/margin.h>
#include <vmlight/uv/raster.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

namespace vmlight {
namespace {

using Imath::C3f;
using Imath::V2d;

constexpr int kSeenChannels = 4, kAllChannels = kSeenChannels + 3; // V and B, which the margin goes by, then R, G, B

// How the weights of a triangle's corners change from one texel to the next.
void find_differentials(FramePoint& dst, const Mesh& mesh, uint32_t triangle, int width, int height)
{
    const auto& corners = mesh.triangles[triangle];
    const V2d a(mesh.uvs[corners[0]]), ab = V2d(mesh.uvs[corners[1]]) - a, ac = V2d(mesh.uvs[corners[2]]) - a;
    const double area = ab.cross(ac);
    dst.weight_dx = dst.weight_dy = {};
    if (area == 0)
        return;
    const auto set = [&](std::array<double, 3>& weight, const V2d& step) {
        weight[1] = step.cross(ac) / area;
        weight[2] = ab.cross(step) / area;
        weight[0] = -weight[1] - weight[2];
    };
    set(dst.weight_dx, V2d(1.0 / width, 0));
    set(dst.weight_dy, V2d(0, 1.0 / height));
}

void look_up_tile(float* pixels, Coverage& coverage, const FrameSurface& surface, const UvRaster& raster, int tile,
                  float otherwise)
{
    const auto cover = std::make_unique<TileCover>();
    raster.cover(tile, *cover);
    const int width = coverage.width(), height = coverage.height(), across = raster.tiles_across();
    const int left = tile % across * kTileSize, top = tile / across * kTileSize;
    SeenPoint seen;
    seen.surface = &surface;
    seen.point.position = Imath::V3d(0); // copied, though no colour depends on it
    for (int y = top; y < std::min(top + kTileSize, height); ++y)
        for (int x = left; x < std::min(left + kTileSize, width); ++x) {
            const size_t i = size_t(y - top) * kTileSize + size_t(x - left);
            seen.triangle = cover->triangle[i];
            if (seen.triangle == TileCover::kNone)
                continue;
            const double second = double(cover->weight1[i]), third = double(cover->weight2[i]);
            seen.point.weight = { 1 - second - third, second, third };
            find_differentials(seen.point, *surface.mesh, seen.triangle, width, height);
            C3f albedo(otherwise, otherwise, otherwise);
            look_up_albedo(albedo, seen, 0);
            float* pixel = pixels + kAllChannels * (size_t(y) * size_t(width) + size_t(x)) + kSeenChannels;
            std::copy_n(&albedo.x, 3, pixel);
            coverage.set(x, y);
        }
}

} // namespace

OIIO::ImageBuf texel_albedo(const FrameSurface& surface, const OIIO::ImageBuf& vismap, int udim, float otherwise,
                            int nthreads)
{
    const OIIO::ImageSpec& spec = vismap.spec();
    const int width = spec.width, height = spec.height;
    const size_t texels = size_t(width) * size_t(height);
    std::vector<float> pixels(kAllChannels * texels);
    std::array<int, 4> index;
    std::string ignored; // who lights the map refuses it
    if (find_vismap_channels(spec, index, ignored) && vismap.localpixels()) {
        const auto* seen = static_cast<const float*>(vismap.localpixels());
        for (size_t i = 0; i < texels; ++i)
            for (size_t c = 0; c < index.size(); ++c)
                pixels[kAllChannels * i + c] = seen[i * size_t(spec.nchannels) + size_t(index[c])];
    }
    Coverage coverage(width, height);
    const UvRaster raster(*surface.mesh, width, height, udim);
    parallel_items(int64_t(raster.tiles_across()) * raster.tiles_down(), nthreads, [&](int64_t tile, int) {
        look_up_tile(pixels.data(), coverage, surface, raster, int(tile), otherwise);
    });
    fill_margin(pixels.data(), kAllChannels, coverage, -1, { kAllChannels, 0 });
    OIIO::ImageBuf albedo(OIIO::ImageSpec(width, height, 3, OIIO::TypeFloat));
    auto* dst = static_cast<float*>(albedo.localpixels());
    for (size_t i = 0; i < texels; ++i)
        std::copy_n(&pixels[kAllChannels * i + kSeenChannels], 3, dst + 3 * i);
    return albedo;
}

} // namespace vmlight
