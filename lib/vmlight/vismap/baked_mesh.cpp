// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/baked_mesh.h>

#include <vmlight/mesh/shape.h>

#include <string>

namespace vmlight {

bool is_baked_of(const Mesh& mesh, const OIIO::ImageSpec& vismap)
{
    const std::string hash = vismap.get_string_attribute("vmlight:meshHash");
    return hash.empty() || hash == mesh_hash(mesh)
        || same_shape(vismap.get_string_attribute("vmlight:meshShape"), mesh_shape(mesh));
}

} // namespace vmlight
