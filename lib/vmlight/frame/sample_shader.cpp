// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/sample_shader.h>

#include <vmlight/frame/surface_color.h>
#include <vmlight/math/ray_fan.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {
namespace {

using Imath::C3f;

constexpr int kMostLayersOfAlpha = 32;

} // namespace

SampleShader::SampleShader(const FrameScene& scene, const Camera& camera, bool with_visibility)
    : m_scene(scene)
    , m_with_visibility(with_visibility)
    , m_start(std::max(0.0, (scene.centre - camera.position).dot(camera.forward) - 1.001 * scene.radius))
{
}

bool SampleShader::shade(FrameSample* samples, const CameraRay* rays, int count, std::string& error) const
{
    std::array<SurfaceRay, kPacketSize> packet;
    std::array<SurfaceHit, kPacketSize> hits;
    for (int i = 0; i < count; ++i)
        packet[i] = { rays[i].origin, rays[i].direction, m_start };
    m_scene.tracer->find(packet.data(), count, hits.data());
    for (int i = 0; i < count; ++i)
        if (!look_through(samples[i], rays[i], hits[i], error))
            return false;
    return true;
}

// From front to back, as far as there is something to see through.
bool SampleShader::look_through(FrameSample& dst, const CameraRay& ray, SurfaceHit hit, std::string& error) const
{
    double open = 1, start = m_start;
    dst = {};
    for (int depth = 0; hit.exists() && depth < kMostLayersOfAlpha && open > 0; ++depth) {
        SeenPoint seen;
        seen.surface = &m_scene.surfaces[hit.mesh];
        seen.triangle = hit.triangle;
        if (hit.is_strand())
            place_on_strand(seen, ray, hit);
        if (hit.is_strand() || intersect_plane(seen.point, ray, *seen.surface->mesh, hit.triangle)) {
            look_up_material(seen);
            if (seen.alpha > 0 && !add_surface(dst, seen, open, error))
                return false;
            if (!(open > 0))
                break;
            start = std::max(start, seen.point.depth);
        }
        // Behind the surface that was met, by more than its position is rounded.
        start += 4e-7 * (std::abs(start) + m_scene.radius);
        const SurfaceRay onward { ray.origin, ray.direction, start };
        m_scene.tracer->find(&onward, 1, &hit);
    }
    if (m_scene.background.is_visible && open > 0) {
        dst.color += m_scene.background.look(ray) * float(open);
        open = 0;
    }
    dst.alpha = 1 - open;
    return true;
}

bool SampleShader::add_surface(FrameSample& dst, SeenPoint& seen, double& open, std::string& error) const
{
    const bool has_specular = seen.surface->specular != nullptr;
    if (!look_up_light(seen, has_specular || (m_with_visibility && !dst.first.surface), error))
        return false;
    C3f color = seen.light * seen.albedo + seen.specular * seen.visibility[0];
    if (seen.surface->catches_shadows) {
        const float lit = (seen.light.x + seen.light.y + seen.light.z) / 3;
        const float share = seen.surface->unshadowed > 0 ? lit / seen.surface->unshadowed : 1;
        seen.alpha *= double(std::clamp(1 - share, 0.0f, 1.0f));
        color = C3f(0, 0, 0);
    }
    dst.color += color * float(seen.alpha * open);
    open *= 1 - seen.alpha;
    if (!dst.first.surface)
        dst.first = seen;
    return true;
}

} // namespace vmlight
