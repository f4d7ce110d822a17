// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/import.h>

#include <vmlight/mesh/import/collada.h>
#include <vmlight/mesh/import/fbx.h>
#include <vmlight/mesh/import/gltf.h>
#include <vmlight/mesh/import/obj.h>
#include <vmlight/mesh/import/ply.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmlight {

using Imath::V3d;

namespace {

// In letters of either case, of one or two bytes each.
bool says(std::string bytes, const char* text)
{
    bytes.erase(std::remove(bytes.begin(), bytes.end(), '\0'), bytes.end());
    return OIIO::Strutil::lower(bytes).find(text) != std::string::npos;
}

} // namespace

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
    if (const MeshFile fbx = inspect_fbx(path); !fbx.fault.empty())
        return fbx; // FBX has many names
    const std::string extension = Strutil::lower(Filesystem::extension(path));
    const bool is_obj = extension == ".obj";
    std::string bytes(4096, '\0');
    bytes.resize(Filesystem::read_bytes(path, bytes.data(), bytes.size()));
    if (Strutil::starts_with(bytes, "PK\3\4")) {
        MeshFile file;
        file.fault = "a zip archive, not a mesh: unpack it";
        return file;
    }
    // Some are known to the importer by what they hold, whatever their names.
    const bool is_collada = extension == ".dae" || says(bytes, "<collada"), is_ply = Strutil::starts_with(bytes, "ply");
    const bool is_gltf = extension == ".gltf" || extension == ".glb" || Strutil::starts_with(bytes, "glTF");
    if (!is_obj && !is_gltf && !is_collada && !is_ply)
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
