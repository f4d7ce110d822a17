// SPDX-License-Identifier: Apache-2.0
/// What opacity micromaps are compared with: a callback and a texture lookup at every hit.
#pragma once

#include <vmlight/base/oiio_compat.h>
#include <vmlight/math/ray_fan.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/opacity.h>
#include <vmlight/trace/embree_scene.h>
#include <vmlight/trace/occluder.h>

#include <OpenImageIO/texture.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// A scene of triangles of several materials: 0 is opaque, of the others OpenImageIO's texture system says at every hit
/// whether they are.
struct TextureSystemScene
{
    /// @param mesh     whose MeshOpacity has one set of uvs, for the first texture of its materials
    /// @param textures  a file for each material but 0: alpha, cut at one half
    TextureSystemScene(const Mesh& mesh, const SceneFrame& frame, const std::vector<std::string>& textures)
        : system(oiio::private_texture_system())
        , uvs(&mesh.opacity->uvs[0])
        , device(rtcNewDevice("set_affinity=0"))
        , scene(rtcNewScene(device))
    {
        for (const std::string& texture : textures)
            handles.push_back(system->get_texture_handle(OIIO::ustring(texture)));
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        for (int part = 0; part < 2; ++part) {
            RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
            auto* vertices = static_cast<Imath::V3f*>(rtcSetNewGeometryBuffer(
                geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Imath::V3f), mesh.positions.size()));
            for (size_t v = 0; v < mesh.positions.size(); ++v)
                vertices[v] = frame.to_scene(mesh.positions[v]);
            std::vector<std::array<uint32_t, 3>> triangles;
            for (size_t t = 0; t < mesh.triangles.size(); ++t)
                if ((mesh.triangle_materials[t] > 0) == (part > 0)) {
                    triangles.push_back(mesh.triangles[t]);
                    if (part)
                        leaves.push_back({ t, mesh.triangle_materials[t] - 1 });
                }
            std::memcpy(
                rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles.size()),
                triangles.data(), triangles.size() * 12);
            rtcSetGeometryUserData(geometry, this);
            if (part)
                rtcSetGeometryOccludedFilterFunction(geometry, filter);
            rtcCommitGeometry(geometry);
            rtcAttachGeometry(scene, geometry);
            rtcReleaseGeometry(geometry);
        }
        rtcCommitScene(scene);
    }
    ~TextureSystemScene()
    {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    static void filter(const RTCFilterFunctionNArguments* arguments)
    {
        const auto& self = *static_cast<const TextureSystemScene*>(arguments->geometryUserPtr);
        const unsigned n = arguments->N;
        auto* thread = self.system->get_perthread_info();
        OIIO::TextureOpt options;
        options.swrap = options.twrap = OIIO::TextureOpt::WrapClamp;
        options.interpmode = OIIO::TextureOpt::InterpBilinear;
        options.mipmode = OIIO::TextureOpt::MipModeNoMIP;
        for (unsigned i = 0; i < n; ++i) {
            if (!arguments->valid[i])
                continue;
            const float u = RTCHitN_u(arguments->hit, n, i), v = RTCHitN_v(arguments->hit, n, i);
            const Leaf& leaf = self.leaves[RTCHitN_primID(arguments->hit, n, i)];
            const Imath::V2f* uvs = &(*self.uvs)[3 * leaf.triangle];
            const Imath::V2f st = uvs[0] + (uvs[1] - uvs[0]) * u + (uvs[2] - uvs[0]) * v;
            float alpha = 1;
            if (!self.system->texture(self.handles[leaf.texture], thread, options, st.x, 1 - st.y, 0, 0, 0, 0, 1,
                                      &alpha)) {
                std::printf("%s\n", self.system->geterror().c_str());
                std::exit(1);
            }
            if (!(alpha >= 0.5f))
                arguments->valid[i] = 0;
        }
    }
    void clear_blocked(RayFan& fan, const Imath::V3f& origin) const
    {
        const embree::FlushDenormals flush;
        embree::Query query;
        RTCRay8 rays;
        for (int lane = 0; lane < kPacketSize; ++lane) {
            rays.org_x[lane] = origin.x, rays.org_y[lane] = origin.y, rays.org_z[lane] = origin.z;
            embree::prepare_lane(rays, lane);
        }
        for (int packet = 0; packet < fan.packets; ++packet) {
            alignas(32) int valid[kPacketSize];
            for (int lane = 0; lane < kPacketSize; ++lane) {
                valid[lane] = fan.lanes[packet] >> lane & 1 ? -1 : 0;
                rays.tfar[lane] = std::numeric_limits<float>::infinity();
            }
            std::memcpy(rays.dir_x, fan.x + packet * kPacketSize, sizeof(rays.dir_x));
            std::memcpy(rays.dir_y, fan.y + packet * kPacketSize, sizeof(rays.dir_y));
            std::memcpy(rays.dir_z, fan.z + packet * kPacketSize, sizeof(rays.dir_z));
            query.occluded8(valid, scene, rays);
            for (int lane = 0; lane < kPacketSize; ++lane)
                if (!(rays.tfar[lane] >= 0))
                    fan.lanes[packet] &= uint8_t(~(1u << lane));
        }
    }

    std::shared_ptr<OIIO::TextureSystem> system;
    std::vector<OIIO::TextureSystem::TextureHandle*> handles;
    const std::vector<Imath::V2f>* uvs;
    struct Leaf
    {
        size_t triangle;
        uint32_t texture;
    };
    std::vector<Leaf> leaves;
    RTCDevice device;
    RTCScene scene;
};

} // namespace vmlight
