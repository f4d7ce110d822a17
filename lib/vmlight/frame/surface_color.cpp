// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/surface_color.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {
namespace {

using Imath::V2d;
using Imath::V2f;
using Imath::V3d;

std::array<V2d, 3> mesh_uvs(const Mesh& mesh, uint32_t triangle)
{
    const auto& corners = mesh.triangles[triangle];
    return { V2d(mesh.uvs[corners[0]]), V2d(mesh.uvs[corners[1]]), V2d(mesh.uvs[corners[2]]) };
}

TextureFootprint material_footprint(const SeenPoint& seen, const SurfaceMaterial& material)
{
    TextureFootprint at = seen.uv;
    const auto& sets = seen.surface->material_uvs;
    if (size_t(material.uv_set) < sets.size() && !sets[material.uv_set].empty()) {
        const V2f* uvs = &sets[material.uv_set][size_t(seen.triangle) * 3];
        at = seen.point.footprint({ V2d(uvs[0]), V2d(uvs[1]), V2d(uvs[2]) });
    }
    const auto& m = material.uv_transform;
    const auto turned = [&](const V2d& v) { return V2d(v.x * m[0][0] + v.y * m[1][0], v.x * m[0][1] + v.y * m[1][1]); };
    at.st = turned(at.st) + V2d(m[2][0], m[2][1]);
    at.dx = turned(at.dx);
    at.dy = turned(at.dy);
    // From v up to rows from the top.
    at.st.y = 1 - at.st.y;
    at.dx.y = -at.dx.y;
    at.dy.y = -at.dy.y;
    return at;
}

double fade(const FrameSurface& surface, const V3d& position)
{
    if (!(surface.fade_end > surface.fade_start))
        return 1;
    const double far = (position - surface.fade_centre).length();
    const double x = std::clamp((surface.fade_end - far) / (surface.fade_end - surface.fade_start), 0.0, 1.0);
    return x * x * (3 - 2 * x);
}

} // namespace

void look_up_material(SeenPoint& seen)
{
    const Mesh& mesh = *seen.surface->mesh;
    if (!mesh.uvs.empty())
        seen.uv = seen.point.footprint(mesh_uvs(mesh, seen.triangle));
    seen.alpha = seen.surface->opacity * fade(*seen.surface, seen.point.position);
    if (seen.surface->materials.empty() || mesh.triangle_materials.empty())
        return;
    const SurfaceMaterial& material = seen.surface->materials[mesh.triangle_materials[seen.triangle]];
    seen.albedo = material.color;
    float alpha = material.alpha;
    if (material.texture) {
        std::array<float, 4> texel {};
        const TextureFootprint at = material_footprint(seen, material);
        if (std::isfinite(at.st.x + at.st.y + at.dx.x + at.dx.y + at.dy.x + at.dy.y)) {
            material.texture->lookup(at, texel.data());
            seen.albedo *= Imath::C3f(texel[0], texel[1], texel[2]);
            alpha *= texel[3];
        }
    }
    if (material.alpha_mode == AlphaMode::mask)
        seen.alpha *= alpha >= material.alpha_cutoff ? 1 : 0;
    else if (material.alpha_mode == AlphaMode::blend)
        seen.alpha *= double(std::clamp(alpha, 0.0f, 1.0f));
}

bool look_up_light(SeenPoint& seen, bool with_visibility, std::string& error)
{
    const FrameSurface& surface = *seen.surface;
    const double is_finite = seen.uv.st.x + seen.uv.st.y + seen.uv.dx.x + seen.uv.dx.y + seen.uv.dy.x + seen.uv.dy.y;
    if (surface.mesh->uvs.empty() || !std::isfinite(is_finite))
        return true; // a triangle without UVs has no texels
    if (surface.light && !surface.light->lookup(seen.uv, &seen.light.x, error))
        return false;
    return !with_visibility || !surface.visibility
        || surface.visibility->lookup(seen.uv, seen.visibility.data(), error);
}

} // namespace vmlight
