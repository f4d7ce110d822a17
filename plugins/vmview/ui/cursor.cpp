// SPDX-License-Identifier: Apache-2.0
#include "cursor.h"

#include <vmlight/base/format.h>
#include <vmlight/frame/surface_point.h>
#include <vmlight/image/channels.h>
#include <vmlight/uv/udim.h>

#include <array>
#include <cmath>

namespace vmlight::view {

CursorTexel texel_under(const MeshAsset& mesh, const MapAsset* map, const Camera& camera, double x, double y, int width,
                        int height)
{
    CursorTexel found;
    const CameraRay ray = camera.ray(x, y, width, height);
    const SurfaceRay one { ray.origin, ray.direction, 0 };
    SurfaceHit hit;
    mesh.surface.find(&one, 1, &hit);
    FramePoint point;
    if (!hit.exists() || !intersect_plane(point, ray, *mesh.mesh, hit.triangle))
        return found;
    found.is_on_mesh = true;
    found.triangle = hit.triangle;
    if (mesh.mesh->uvs.empty())
        return found;
    const auto& corners = mesh.mesh->triangles[hit.triangle];
    for (size_t k = 0; k < 3; ++k)
        found.uv += Imath::V2d(mesh.mesh->uvs[corners[k]]) * point.weight[k];
    if (!map || !std::isfinite(found.uv.x + found.uv.y))
        return found;
    const OIIO::ImageSpec& spec = map->image.spec();
    const Imath::V2d in_tile = found.uv - Imath::V2d(udim_corner(mesh.recipe.vismap_params.udim));
    found.x = int(std::floor(in_tile.x * spec.width));
    found.y = int(std::floor((1 - in_tile.y) * spec.height));
    found.has_texel = found.x >= 0 && found.x < spec.width && found.y >= 0 && found.y < spec.height;
    return found;
}

std::string describe_texel(const MapAsset& map, int x, int y)
{
    const OIIO::ImageSpec& spec = map.image.spec();
    std::array<int, 4> index;
    std::string text;
    if (!find_vismap_channels(spec, index, text))
        return text;
    std::vector<float> pixel(size_t(spec.nchannels));
    map.image.getpixel(spec.x + x, spec.y + y, 0, pixel.data(), spec.nchannels);
    const float b[3] = { pixel[size_t(index[1])], pixel[size_t(index[2])], pixel[size_t(index[3])] };
    const float v = pixel[size_t(index[0])], length = std::sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    text = format("V {:.4f}\nB {:.4f} {:.4f} {:.4f}\n|B| / V {:.4f}", v, b[0], b[1], b[2], v > 0 ? length / v : 0.0f);
    const int error = spec.channelindex(kErrorChannel);
    if (error >= 0)
        text += format("\nerror of V {:.4f}", pixel[size_t(error)]);
    return text;
}

} // namespace vmlight::view
