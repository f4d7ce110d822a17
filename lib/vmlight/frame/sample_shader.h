// SPDX-License-Identifier: Apache-2.0
/// What one camera ray sees.
#pragma once

#include <vmlight/frame/camera.h>
#include <vmlight/frame/frame_scene.h>
#include <vmlight/frame/layers.h>

#include <string>

namespace vmlight {

struct FrameSample
{
    /// Times alpha.
    Imath::C3f color { 0, 0, 0 };
    double alpha = 0;
    /// The first point that is not wholly transparent; without a surface if there is none.
    SeenPoint first;
};

/// Any number of threads may call it.
class SampleShader
{
public:
    /// @param with_visibility  whether SeenPoint::visibility is needed
    SampleShader(const FrameScene& scene, const Camera& camera, bool with_visibility);

    /// See what the first `count` of kPacketSize rays see. Their differentials are the reach of texture lookups. False,
    /// with the reason in `error`, if a texture cannot be read.
    bool shade(FrameSample* samples, const CameraRay* rays, int count, std::string& error) const;

private:
    bool look_through(FrameSample& dst, const CameraRay& ray, SurfaceHit hit, std::string& error) const;
    bool add_surface(FrameSample& dst, SeenPoint& seen, double& open, std::string& error) const;

    const FrameScene& m_scene;
    const bool m_with_visibility;
    double m_start; // nothing is nearer to the camera
};

} // namespace vmlight
