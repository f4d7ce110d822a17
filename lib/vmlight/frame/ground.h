// SPDX-License-Identifier: Apache-2.0
/// The ground under objects: a square whose visibility map catches their occlusion, relit like them.
#pragma once

#include <vmlight/frame/camera.h>
#include <vmlight/frame/lit_object.h>
#include <vmlight/mesh/mesh.h>

#include <memory>
#include <string>

namespace vmlight {

/// How many times as far as the objects' corners the ground reaches.
constexpr double kGroundReach = 4;

/// A horizontal square with UVs, just below `subject`, in the space of an object that `pose` has turned.
///
/// @param texture  an image for its material; "" for none
std::shared_ptr<const Mesh> make_ground_mesh(const Subject& subject, const Rotation& pose, const std::string& texture);

/// Let the ground's opacity fall to 0 towards its border, so that it has none.
void fade_out(FrameSurface& ground);

/// The light of the ground where nothing is in its way, the mean of R, G and B: what a shadow is measured against.
/// False, with the reason in `error`, as make_lightmap().
bool find_unshadowed(float& dst, const Mesh& ground, const SceneLight& light, const LightmapParams& params,
                     std::string& error);

} // namespace vmlight
