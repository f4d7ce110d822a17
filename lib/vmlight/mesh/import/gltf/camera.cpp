// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/camera.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/gltf/error.h>

#include <cmath>

namespace vmlight::gltf {

using Imath::V3d;

MeshCamera read_camera(const std::vector<CameraShape>& cameras, const tinygltf::Node& node,
                       const Imath::M44d& to_object)
{
    if (node.camera < 0 || size_t(node.camera) >= cameras.size())
        throw Error(format("node \"{}\" has camera {}, but there are only {}", node.name, node.camera, cameras.size()));
    const CameraShape& source = cameras[size_t(node.camera)];
    MeshCamera camera;
    camera.name = source.name.empty() ? node.name : source.name;
    camera.node = node.name;
    camera.is_orthographic = source.type == "orthographic";
    if (camera.is_orthographic) {
        camera.half_height = std::abs(source.ymag);
        camera.aspect = std::abs(source.xmag) / camera.half_height;
    } else {
        camera.half_height = std::tan(0.5 * source.yfov);
        camera.aspect = source.aspect;
    }
    to_object.multVecMatrix(V3d(0), camera.position);
    V3d up, back;
    to_object.multDirMatrix(V3d(0, 1, 0), up);
    to_object.multDirMatrix(V3d(0, 0, 1), back);
    // Scales move the camera and do not change what it shows (glTF 2.0, 3.10.3.2); shears are left out.
    camera.forward = -back.normalized();
    camera.right = up.cross(back).normalized();
    camera.up = camera.right.cross(camera.forward);
    const bool is_finite = std::isfinite(camera.position.x + camera.position.y + camera.position.z)
        && camera.right.length2() > 0.5 && camera.forward.length2() > 0.5;
    if (!is_finite || !(camera.half_height > 0) || !std::isfinite(camera.half_height) || !(camera.aspect >= 0)
        || !std::isfinite(camera.aspect))
        throw Error(format("camera \"{}\" has a field of view, size or transform that makes no picture", camera.name));
    return camera;
}

} // namespace vmlight::gltf
