// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh_file.h>

#include <vmlight/mesh_file_collada.h>
#include <vmlight/mesh_file_gltf.h>
#include <vmlight/mesh_file_obj.h>
#include <vmlight/mesh_file_ply.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmlight {

using Imath::V3d;

bool lie_far_from_origin(const std::vector<V3d>& positions)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    V3d low(infinity), high(-infinity);
    bool finite = true;
    for (const V3d& p : positions)
        for (int axis = 0; axis < 3; ++axis) {
            finite &= std::isfinite(p[axis]);
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    if (!finite || positions.empty())
        return false;
    double side = 0, reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
        side = std::max(side, high[axis] - low[axis]);
        reach = std::max({ reach, std::abs(low[axis]), std::abs(high[axis]) });
    }
    return side > 0 && reach > kFarFromOrigin * side;
}

MeshFile inspect_mesh_file(const std::string& path)
{
    using namespace OIIO;
    const std::string extension = Strutil::lower(Filesystem::extension(path));
    const bool is_obj = extension == ".obj", is_gltf = extension == ".gltf" || extension == ".glb";
    const bool is_collada = extension == ".dae";
    std::string bytes(3, '\0');
    bytes.resize(Filesystem::read_bytes(path, bytes.data(), bytes.size()));
    if (!is_obj && !is_gltf && !is_collada && bytes != "ply")
        return {};
    bytes.resize(Filesystem::file_size(path));
    bytes.resize(Filesystem::read_bytes(path, bytes.data(), bytes.size()));
    if (is_gltf || is_collada) {
        MeshFile file;
        file.fault = is_gltf ? gltf_fault(bytes) : collada_fault(bytes);
        return file;
    }
    return is_obj ? inspect_obj(bytes) : inspect_ply(bytes);
}

} // namespace vmlight
