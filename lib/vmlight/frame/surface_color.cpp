// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/surface_color.h>

#include <vmlight/mesh/opacity.h>

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

TextureFootprint material_footprint(const SeenPoint& seen, int uv_set, const Imath::M33d& m)
{
    TextureFootprint at = seen.uv;
    const auto& sets = seen.surface->material_uvs;
    if (size_t(uv_set) < sets.size() && !sets[uv_set].empty()) {
        const V2f* uvs = &sets[uv_set][size_t(seen.triangle) * 3];
        at = seen.point.footprint({ V2d(uvs[0]), V2d(uvs[1]), V2d(uvs[2]) });
    }
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

// Set `texel` to what a texture has there; nothing where the point has no uvs. `reach` as for look_up_albedo().
bool look_up(float* texel, const SeenPoint& seen, const TexturePyramid& texture, int uv_set,
             const Imath::M33d& transform, double reach = 0)
{
    TextureFootprint at = material_footprint(seen, uv_set, transform);
    if (reach > 0) {
        at.dx = V2d(reach, 0);
        at.dy = V2d(0, reach);
    }
    if (!std::isfinite(at.st.x + at.st.y + at.dx.x + at.dx.y + at.dy.x + at.dy.y))
        return false;
    texture.lookup(at, texel);
    return true;
}

double fade(const FrameSurface& surface, const V3d& position)
{
    if (!(surface.fade_end > surface.fade_start))
        return 1;
    const double far = (position - surface.fade_centre).length();
    const double x = std::clamp((surface.fade_end - far) / (surface.fade_end - surface.fade_start), 0.0, 1.0);
    return x * x * (3 - 2 * x);
}

// nullptr: white.
const SurfaceMaterial* material_of(const SeenPoint& seen)
{
    const TriangleIndices& numbers = seen.surface->mesh->triangle_materials;
    return seen.surface->materials.empty() || numbers.empty() ? nullptr
                                                              : &seen.surface->materials[numbers[seen.triangle]];
}

// White is what a material has that says nothing of its colour.
bool has_color(const SurfaceMaterial& material)
{
    return material.texture || material.color != Imath::C3f(1, 1, 1);
}

} // namespace

bool has_all_colors(const FrameSurface& surface)
{
    const TriangleIndices& numbers = surface.mesh->triangle_materials;
    return !surface.materials.empty() && !numbers.empty()
        && std::all_of(numbers.begin(), numbers.end(),
                       [&](uint32_t number) { return has_color(surface.materials[number]); });
}

bool look_up_albedo(Imath::C3f& dst, const SeenPoint& seen, double reach)
{
    const SurfaceMaterial* material = material_of(seen);
    if (!material || !has_color(*material))
        return false;
    SeenPoint at = seen;
    if (!seen.surface->mesh->uvs.empty())
        at.uv = seen.point.footprint(mesh_uvs(*seen.surface->mesh, seen.triangle));
    dst = material->color;
    std::array<float, 4> texel {};
    if (material->texture
        && look_up(texel.data(), at, *material->texture, material->uv_set, material->uv_transform, reach))
        dst *= Imath::C3f(texel[0], texel[1], texel[2]);
    for (int c = 0; c < 3; ++c)
        dst[c] = std::max(0.0f, dst[c]);
    return true;
}

void place_on_strand(SeenPoint& seen, const CameraRay& ray, const SurfaceHit& hit)
{
    const StrandSurface& strands = *seen.surface->strands;
    seen.point.depth = hit.distance;
    seen.point.position = ray.origin + ray.direction * hit.distance;
    seen.uv.st = strands.uv(hit.span, hit.along); // without a reach: no strand is mixed with the next row of the map
    const V3d tangent = strands.tangent(hit.span);
    seen.strand_normal = (tangent * ray.direction.dot(tangent) - ray.direction).normalized();
    if (seen.surface->specular)
        seen.specular = seen.surface->specular->look(strands.tangent(hit.span, hit.along), ray.direction);
}

void look_up_material(SeenPoint& seen)
{
    const Mesh& mesh = *seen.surface->mesh;
    if (!mesh.uvs.empty())
        seen.uv = seen.point.footprint(mesh_uvs(mesh, seen.triangle));
    seen.alpha = seen.surface->opacity * fade(*seen.surface, seen.point.position);
    if (seen.surface->strands)
        seen.albedo = seen.surface->strand_color;
    const SurfaceMaterial* found = material_of(seen);
    if (!found)
        return;
    const SurfaceMaterial& material = *found;
    seen.albedo = material.color;
    float alpha = material.alpha;
    std::array<float, 4> texel {};
    if (material.texture && look_up(texel.data(), seen, *material.texture, material.uv_set, material.uv_transform)) {
        seen.albedo *= Imath::C3f(texel[0], texel[1], texel[2]);
        alpha *= texel[3];
    }
    if (material.opacity
        && look_up(texel.data(), seen, *material.opacity, material.opacity_uv_set, material.opacity_transform))
        alpha *= texel[0];
    seen.alpha *= opacity_of(material.alpha_mode, double(alpha), double(material.alpha_cutoff));
}

bool look_up_light(SeenPoint& seen, bool with_visibility, std::string& error)
{
    const FrameSurface& surface = *seen.surface;
    const double is_finite = seen.uv.st.x + seen.uv.st.y + seen.uv.dx.x + seen.uv.dx.y + seen.uv.dy.x + seen.uv.dy.y;
    if ((surface.mesh->uvs.empty() && !surface.strands) || !std::isfinite(is_finite))
        return true; // a triangle without UVs has no texels
    if (surface.light && !surface.light->lookup(seen.uv, &seen.light.x, error))
        return false;
    return !with_visibility || !surface.visibility
        || surface.visibility->lookup(seen.uv, seen.visibility.data(), error);
}

} // namespace vmlight
