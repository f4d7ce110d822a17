// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/instances.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/gltf/accessor.h>
#include <vmlight/mesh/import/gltf/document.h>
#include <vmlight/mesh/import/gltf/values.h>

#include <Imath/ImathQuat.h>

#include <string>

namespace vmlight::gltf {

using Imath::M44d;
using Imath::V3d;

std::vector<M44d> read_instances(Document& document, const tinygltf::Node& node)
{
    const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
    if (extension == node.extensions.end())
        return { M44d() };
    if (!extension->second.IsObject() || !extension->second.Has("attributes"))
        throw Error(format("EXT_mesh_gpu_instancing of node \"{}\" has no attributes", node.name));
    const tinygltf::Value& attributes = extension->second.Get("attributes");
    size_t count = 0;
    const auto read = [&](const char* name, int type) {
        if (!attributes.Has(name))
            return Numbers();
        Numbers numbers = read_accessor(document, index_of(attributes, name), type, count,
                                        format("{} of the instances of node \"{}\"", name, node.name));
        count = numbers.count;
        return numbers;
    };
    const Numbers translations = read("TRANSLATION", TINYGLTF_TYPE_VEC3),
                  rotations = read("ROTATION", TINYGLTF_TYPE_VEC4), scales = read("SCALE", TINYGLTF_TYPE_VEC3);
    std::vector<M44d> instances(count);
    for (size_t i = 0; i < count; ++i) {
        if (scales.count)
            instances[i].setScale(V3d(scales[i][0], scales[i][1], scales[i][2]));
        if (rotations.count) {
            const double* q = rotations[i]; // x, y, z, w
            instances[i] *= Imath::Quatd(q[3], q[0], q[1], q[2]).normalized().toMatrix44();
        }
        if (translations.count)
            instances[i] *= M44d().setTranslation(V3d(translations[i][0], translations[i][1], translations[i][2]));
    }
    return instances;
}

} // namespace vmlight::gltf
