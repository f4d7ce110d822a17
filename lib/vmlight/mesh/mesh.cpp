// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/mesh.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/strands.h>

#include <OpenImageIO/hash.h>

#include <array>

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
    const uint64_t hash = fingerprint(parts);
    return format("{:016x}", hash);
}

} // namespace vmlight
