// SPDX-License-Identifier: Apache-2.0
/// One sample of each pixel of a picture, and how shaders are told of it.
#pragma once

#include "../gl/program.h"

#include <vmlight/frame/camera.h>

namespace vmlight::view {

/// What a surface shows; the numbers are those of mesh.frag and strand.frag.
enum class Show
{
    lit = 0,
    checker = 1,
    density = 2,
    colors = 3 ///< the texture as it is, without materials
};

struct View
{
    Camera camera;
    int width = 0, height = 0;
    /// From pixel centres, in pixels, x to the right, y down.
    Imath::V2d offset { 0 };
    int sample = 0; ///< its number among those of the picture
    /// Of texture lookups, in pixels: 1 over the square root of the samples.
    double footprint = 1;
};

/// Set the uniforms of camera.glsl, for positions relative to `centre`.
void set_view(const Program& program, const View& view, const Imath::V3d& centre);

/// The depths between which a subject lies; the nearest is above 0 in perspective.
Imath::V2d depth_range_of(const Camera& camera, const Subject& subject);

} // namespace vmlight::view
