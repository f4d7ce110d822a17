// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/tinygltf.h>

#include <Imath/ImathMatrix.h>

#include <string>
#include <vector>

namespace vmlight::gltf {

/// A camera as the file has it, wherever it stands.
struct CameraShape
{
    std::string name, type;
    double yfov = 0, aspect = 0; ///< of a perspective one; radians
    double xmag = 0, ymag = 0; ///< of an orthographic one
};

/// The camera of `node`, which has one, at `to_object` (for row vectors). Its name is its own, else the node's. Throws
/// Error if the camera does not exist, or its numbers or its transform make no picture: an angle of view of 0 or of 180
/// degrees and more, or a scale of 0.
MeshCamera read_camera(const std::vector<CameraShape>& cameras, const tinygltf::Node& node,
                       const Imath::M44d& to_object);

} // namespace vmlight::gltf
