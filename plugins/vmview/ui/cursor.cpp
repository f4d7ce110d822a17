// SPDX-License-Identifier: Apache-2.0
#include "cursor.h"

#include <vmlight/base/format.h>
#include <vmlight/frame/surface_point.h>
#include <vmlight/image/channels.h>
#include <vmlight/uv/udim.h>

#include <array>
#include <cmath>

namespace vmlight::view {

namespace {

void find_texel(CursorTexel& dst, const Imath::V2d& in_tile, const MapAsset& map)
{
    const OIIO::ImageSpec& spec = map.image.spec();
    dst.x = int(std::floor(in_tile.x * spec.width));
    dst.y = int(std::floor((1 - in_tile.y) * spec.height));
    dst.has_texel = dst.x >= 0 && dst.x < spec.width && dst.y >= 0 && dst.y < spec.height;
}

} // namespace

CursorTexel texel_under(const MeshAsset& mesh, const MapAsset* map, const Camera& camera, double x, double y, int width,
                        int height)
{
    CursorTexel found;
    const CameraRay ray = camera.ray(x, y, width, height);
    const SurfaceRay one { ray.origin, ray.direction, 0 };
    SurfaceHit hit;
    mesh.surface.find(&one, 1, &hit);
    FramePoint point;
    if (!hit.exists())
        return found;
    if (hit.is_strand()) {
        found.figure = hit.mesh;
        const StrandObject& strands = (hit.mesh == 0 ? mesh : *mesh.beside[hit.mesh - 1]).strands;
        const MapAsset* own = hit.mesh == 0 || !map ? map
            : hit.mesh <= map->beside.size()        ? map->beside[hit.mesh - 1].get()
                                                    : nullptr;
        found.is_on_strand = true;
        found.uv = strands.surface->uv(hit.span, hit.along);
        const Size size = strands.layout.size();
        found.strand = strands.layout.strand_at(int(found.uv.x * size.width), int((1 - found.uv.y) * size.height));
        if (own)
            find_texel(found, found.uv, *own);
        return found;
    }
    if (!intersect_plane(point, ray, *mesh.mesh, hit.triangle))
        return found;
    found.is_on_mesh = true;
    found.triangle = hit.triangle;
    if (mesh.mesh->uvs.empty())
        return found;
    const auto& corners = mesh.mesh->triangles[hit.triangle];
    for (size_t k = 0; k < 3; ++k)
        found.uv += Imath::V2d(mesh.mesh->uvs[corners[k]]) * point.weight[k];
    if (map && std::isfinite(found.uv.x + found.uv.y))
        find_texel(found, found.uv - Imath::V2d(udim_corner(mesh.recipe.vismap_params.udim)), *map);
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
