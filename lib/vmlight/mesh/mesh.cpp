// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/mesh.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/instances.h>
#include <vmlight/mesh/strands.h>

#include <OpenImageIO/hash.h>

#include <array>
#include <vector>

namespace vmlight {

std::string mesh_hash(const Mesh& mesh)
{
    if (mesh.strands)
        return strands_hash(*mesh.strands);
    const auto fingerprint = [](const auto& elements) {
        const char* bytes = reinterpret_cast<const char*>(elements.data());
        return OIIO::farmhash::Fingerprint64(bytes, elements.size() * sizeof(elements[0]));
    };
    const std::array<uint64_t, 4> parts { fingerprint(mesh.positions), fingerprint(mesh.normals), fingerprint(mesh.uvs),
                                          fingerprint(mesh.triangles) };
    const std::string own = format("{:016x}", fingerprint(parts));
    if (!mesh.instances)
        return own;
    std::string all = own;
    for (const Mesh& distinct : mesh.instances->meshes)
        all += mesh_hash(distinct);
    std::vector<double> places;
    for (const MeshInstances::Place& place : mesh.instances->places) {
        places.push_back(place.mesh);
        places.insert(places.end(), place.to_object.getValue(), place.to_object.getValue() + 16);
    }
    const std::array<uint64_t, 2> whole { fingerprint(all), fingerprint(places) };
    return format("{:016x}", fingerprint(whole));
}

} // namespace vmlight
