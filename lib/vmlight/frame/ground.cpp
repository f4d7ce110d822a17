// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/ground.h>

#include <vmlight/base/oiio_compat.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/sun_light.h>
#include <vmlight/math/disc.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

double half_side(const Subject& subject)
{
    const V3d size = subject.high() - subject.low();
    return kGroundReach * std::max(0.5 * std::hypot(size.x, size.z), 0.25 * size.y);
}

// What a plane with nothing in its way sees of suns: SunLight::visibility of one texel.
std::vector<float> open_suns(const std::vector<Sun>& suns, const V3d& normal)
{
    std::vector<float> seen;
    for (const Sun& sun : suns) {
        const double up = normal.dot(sun.disc.direction);
        double mean = std::max(0.0, up) * disc_mean_length(sun.disc.half_angle);
        if (std::abs(up) < std::sin(sun.disc.half_angle)) { // the horizon cuts it
            const DiscSamples samples(sun.disc);
            mean = 0;
            for (uint32_t i = 0; i < DiscSamples::kCount; ++i)
                mean += std::max(0.0, normal.dot(V3d(samples.at(i, 0, 1)))) / DiscSamples::kCount;
        }
        seen.push_back(float(mean));
    }
    return seen;
}

} // namespace

std::shared_ptr<const Mesh> make_ground_mesh(const Subject& subject, const Rotation& pose, const std::string& texture)
{
    auto mesh = std::make_shared<Mesh>();
    const double side = half_side(subject);
    // A little below, so that a face that lies on the ground is above it.
    const V3d middle(subject.centre().x, subject.low().y - 1e-4 * subject.radius(), subject.centre().z);
    mesh->name = "ground";
    mesh->positions = { middle + V3d(-side, 0, side), middle + V3d(side, 0, side), middle + V3d(side, 0, -side),
                        middle + V3d(-side, 0, -side) };
    for (V3d& position : mesh->positions)
        position = rotate(pose.transposed(), position);
    mesh->has_exact_positions = true;
    mesh->normals.assign(4, rotate(pose.transposed(), V3f(0, 1, 0)));
    mesh->uvs = { V2f(0, 0), V2f(1, 0), V2f(1, 1), V2f(0, 1) };
    mesh->triangles = { { 0, 1, 2 }, { 0, 2, 3 } };
    if (!texture.empty()) {
        Material material;
        material.base_color_texture.path = texture;
        mesh->materials.push_back(material);
        mesh->triangle_materials = { 0, 0 };
    }
    return mesh;
}

void fade_out(FrameSurface& ground)
{
    const auto& corners = ground.mesh->positions;
    ground.fade_centre = (corners[0] + corners[2]) * 0.5;
    ground.fade_end = (corners[1] - corners[0]).length() * 0.5;
    ground.fade_start = ground.fade_end / 2;
}

bool find_unshadowed(float& dst, const Mesh& ground, const SceneLight& light, const LightmapParams& params,
                     std::string& error)
{
    OIIO::ImageSpec spec(1, 1, 7, OIIO::TypeFloat);
    spec.channelnames.assign(kVismapChannels.begin(), kVismapChannels.end());
    spec.channelnames.insert(spec.channelnames.end(), kNormalChannels.begin(), kNormalChannels.end());
    OIIO::ImageBuf open(spec), lit;
    const V3f n = ground.normals[0], b = n * (2.0f / 3);
    const float texel[7] { 1, b.x, b.y, b.z, n.x, n.y, n.z };
    open.setpixel(0, 0, texel);
    LightmapParams any = params;
    any.model = "paper"; // where nothing is in the way, it is exact, and traced light has its limit there
    float rgb[3];
    Rotation rotation;
    if (!lightmap_rotation(rotation, any, error))
        return false;
    const SunLight suns { light.suns, open.roi(), open_suns(light.suns, rotate(rotation, V3d(n))) };
    if (!make_lightmap(lit, open, light.filtered, light.suns.empty() ? nullptr : &suns, any, nullptr, 0, {})) {
        error = oiio::error_line(lit);
        return false;
    }
    lit.getpixel(0, 0, rgb);
    dst = (rgb[0] + rgb[1] + rgb[2]) / 3;
    return true;
}

} // namespace vmlight
