// SPDX-License-Identifier: Apache-2.0
/// What is behind the objects of a frame.
#pragma once

#include <vmlight/frame/camera.h>
#include <vmlight/frame/texture_pyramid.h>
#include <vmlight/math/rotation.h>

#include <Imath/ImathColor.h>
#include <OpenImageIO/imagebuf.h>

#include <memory>
#include <string>

namespace vmlight {

/// Nothing, a colour, or an environment, which is turned by a rotation from object space.
struct Background
{
    bool is_visible = false;
    Imath::C3f color { 0, 0, 0 };
    /// nullptr, or the environment: three channels, lat-long (math/latlong.h).
    std::shared_ptr<const TexturePyramid> environment;
    Rotation rotation;

    /// What a ray that meets nothing sees.
    Imath::C3f look(const CameraRay& ray) const;
};

/// The pyramid of a lat-long image of R, G, B, float and in memory, blurred by a Gaussian on the sphere of standard
/// deviation `blur` degrees; 0 is sharp. Blurred maps are reduced first to what the blur leaves visible. False, with
/// the reason in `error`, if the image has no colour.
bool make_background(std::shared_ptr<const TexturePyramid>& dst, const OIIO::ImageBuf& environment, double blur,
                     int nthreads, std::string& error);

} // namespace vmlight
