// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/frame_scene.h>

#include <vmlight/frame/camera.h>

#include <cmath>

namespace vmlight {

bool FrameScene::build(int nthreads, std::string& error)
{
    std::vector<const Mesh*> meshes;
    Subject all;
    for (const FrameSurface& surface : surfaces) {
        meshes.push_back(surface.mesh.get());
        all.add(*surface.mesh);
    }
    centre = all.centre();
    radius = all.radius();
    SceneFrame frame;
    frame.centre = centre;
    if (radius > 0)
        frame.scale = std::ldexp(1.0, -int(std::ceil(std::log2(radius))));
    auto built = std::make_shared<VisibleSurface>();
    if (!built->build(meshes, frame, nthreads, error))
        return false;
    tracer = std::move(built);
    return true;
}

} // namespace vmlight
