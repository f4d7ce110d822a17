// SPDX-License-Identifier: Apache-2.0
/// What a seed draws, and the least of it that fails.
#pragma once

#include "drawn_picture.h"

#include <vmlight/base/format.h>

#include <OpenImageIO/imagebufalgo.h>

#include <array>
#include <cstddef>
#include <functional>
#include <string>

namespace vmlight {

inline std::string text_of(const Drawn& drawn)
{
    const DrawnScene& scene = drawn.scene;
    const VismapParams& params = scene.params;
    const auto mesh_text = [](const Mesh& mesh) {
        return format("{} of {} triangles{}", mesh.name, mesh.triangles.size(), mesh.opacity ? " with cut-outs" : "");
    };
    std::string text = mesh_text(scene.mesh);
    for (const Mesh& occluder : scene.occluders)
        text += ", " + mesh_text(occluder);
    const OIIO::ImageSpec &env = drawn.light.environment.spec(), &albedo = drawn.light.albedo.spec();
    return text
        + format("{}{}, basis {}, {} rays, distance {}, margin {}, {} extra channels{}",
                 scene.normal_map.initialized() ? ", normal map" : "", params.ground ? ", ground" : "", params.basis,
                 params.samples, params.max_distance, params.margin, params.channels.size(),
                 params.reconstruct == "off" ? "" : ", reconstructed")
        + format("; environment {}x{}, albedo {}x{}, model {}{}{}, exposure {}", env.width, env.height, albedo.width,
                 albedo.height, drawn.light.params.model, drawn.light.suns ? ", suns" : "",
                 drawn.light.params.rotate.empty() ? "" : ", rotated", drawn.light.params.exposure)
        + (drawn.light.bounce ? ", bounce" : "")
        + std::array { "", "; the same again", "; its first occluder moves", "; its vertices move",
                       "; its first occluder and its vertices move" }[drawn.pose.kind];
}

/// Takes away what a failure does not need: what is left still `fails`, and is printed.
inline std::string shrunk(Drawn drawn, const std::function<bool(const Drawn&)>& fails)
{
    const auto fails_without = [&](auto&& change) {
        Drawn less = drawn;
        change(less);
        if (fails(less))
            drawn = less;
    };
    for (size_t i = drawn.scene.occluders.size(); i-- > 0;)
        fails_without(
            [&](Drawn& less) { less.scene.occluders.erase(less.scene.occluders.begin() + std::ptrdiff_t(i)); });
    for (size_t i = 0; i <= drawn.scene.occluders.size(); ++i)
        fails_without([&](Drawn& less) { less.scene.all_meshes()[i]->opacity = nullptr; });
    const VismapParams plain;
    for (const DrawnPose::Kind less_moves : { DrawnPose::none, DrawnPose::same, DrawnPose::occluder, DrawnPose::mesh })
        if (less_moves < drawn.pose.kind)
            fails_without([&](Drawn& less) { less.pose.kind = less_moves; });
    fails_without([](Drawn& less) { less.light.bounce = false; });
    fails_without([](Drawn& less) { less.scene.normal_map.clear(); });
    fails_without([](Drawn& less) { less.scene.params.reconstruct = "off"; });
    fails_without([](Drawn& less) { less.scene.params.ground = false; });
    fails_without([&](Drawn& less) { less.scene.params.max_distance = plain.max_distance; });
    fails_without([](Drawn& less) { less.light.params = {}; });
    if (drawn.light.params.model != "ao") // needs normals
        fails_without([](Drawn& less) { less.scene.params.channels.clear(); });
    fails_without([](Drawn& less) { less.scene.params.basis = "vector"; });
    fails_without([](Drawn& less) { less.scene.params.margin = 0; });
    // The channel error needs two rays.
    fails_without([](Drawn& less) { less.scene.params.samples = less.scene.params.channels.empty() ? 1 : 2; });
    fails_without([](Drawn& less) { less.light.suns = false; });
    fails_without([](Drawn& less) { less.light.albedo.clear(); });
    fails_without([](Drawn& less) {
        less.light.environment = OIIO::ImageBufAlgo::cut(less.light.environment, { 0, 1, 0, 1 });
    });
    for (size_t i = 0; i <= drawn.scene.occluders.size(); ++i)
        for (size_t t = drawn.scene.all_meshes()[i]->triangles.size(); t-- > 1;)
            fails_without([&](Drawn& less) {
                Mesh& mesh = *less.scene.all_meshes()[i];
                std::vector<size_t> kept;
                for (size_t other = 0; other < mesh.triangles.size(); ++other)
                    if (other != t)
                        kept.push_back(other);
                mesh.triangles.erase(mesh.triangles.begin() + std::ptrdiff_t(t));
                if (mesh.triangle_materials.size() > t)
                    mesh.triangle_materials = picked(mesh.triangle_materials, kept);
            });
    return text_of(drawn);
}

} // namespace vmlight
