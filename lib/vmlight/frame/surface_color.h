// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/frame/frame_scene.h>
#include <vmlight/frame/layers.h>

#include <string>

namespace vmlight {

/// Place `seen`, whose surface is strands, where a camera ray meets one.
void place_on_strand(SeenPoint& seen, const CameraRay& ray, const SurfaceHit& hit);

/// Look up the material, and so colour and opacity, of `seen`, whose point is set.
void look_up_material(SeenPoint& seen);

/// Look up the colour that the material of `seen`, whose point is set, sends back, never negative.
///
/// @param reach    of the lookup in a texture, in its coordinates; 0: that of the point
/// @returns false if no material says a colour: white is what one has that says nothing
bool look_up_albedo(Imath::C3f& dst, const SeenPoint& seen, double reach);

/// Whether the materials of all triangles say a colour.
bool has_all_colors(const FrameSurface& surface);

/// Look up the light, and V and B if asked, of `seen`, whose material is looked up. False, with the reason in `error`,
/// if a texture cannot be read.
bool look_up_light(SeenPoint& seen, bool with_visibility, std::string& error);

} // namespace vmlight
