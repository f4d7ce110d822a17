// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/skin.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/gltf/accessor.h>
#include <vmlight/mesh/import/gltf/document.h>

#include <algorithm>
#include <utility>

namespace vmlight::gltf {
namespace {

using Imath::M44d;
using Imath::V3d;

// From the mesh to the file's space, by joint.
std::vector<M44d> joint_matrices(Document& document, int index, const std::vector<M44d>& transforms)
{
    const auto& skins = document.model().skins;
    if (index < 0 || size_t(index) >= skins.size())
        throw Error(format("there is no skin {}", index));
    const tinygltf::Skin& skin = skins[size_t(index)];
    Numbers inverses;
    if (skin.inverseBindMatrices >= 0)
        inverses = read_accessor(document, skin.inverseBindMatrices, TINYGLTF_TYPE_MAT4, 0, "inverseBindMatrices");
    if (skin.inverseBindMatrices >= 0 && inverses.count < skin.joints.size())
        throw Error(format("skin {} has {} joints, but only {} matrices", index, skin.joints.size(), inverses.count));
    std::vector<M44d> matrices;
    for (size_t joint = 0; joint < skin.joints.size(); ++joint) {
        const int node = skin.joints[joint];
        if (node < 0 || size_t(node) >= transforms.size())
            throw Error(
                format("skin {} has node {} for a joint, but there are only {}", index, node, transforms.size()));
        M44d inverse;
        if (inverses.count)
            std::copy_n(inverses[joint], 16, &inverse[0][0]);
        matrices.push_back(inverse * transforms[size_t(node)]);
    }
    return matrices;
}

} // namespace

void apply_skin(Primitive& primitive, Document& document, int skin, const std::vector<M44d>& transforms)
{
    const std::vector<M44d> matrices = joint_matrices(document, skin, transforms);
    std::vector<bool> is_mirrored(primitive.positions.size(), false);
    for (size_t v = 0; v < primitive.positions.size(); ++v) {
        M44d blended(0.0);
        double sum = 0;
        for (size_t i = v * primitive.influences; i < (v + 1) * primitive.influences; ++i) {
            if (primitive.weights[i] == 0)
                continue;
            if (primitive.joints[i] >= matrices.size())
                throw Error(format("vertex {} follows joint {}, but skin {} has only {}", v, primitive.joints[i], skin,
                                   matrices.size()));
            blended += matrices[primitive.joints[i]] * primitive.weights[i];
            sum += primitive.weights[i];
        }
        if (!(sum > 0))
            continue;
        blended *= 1 / sum;
        V3d moved;
        blended.multVecMatrix(primitive.positions[v], moved);
        primitive.positions[v] = moved;
        if (!primitive.normals.empty()) {
            blended.inverse().transposed().multDirMatrix(primitive.normals[v], moved);
            primitive.normals[v] = moved;
        }
        is_mirrored[v] = blended.determinant() < 0;
    }
    for (auto& triangle : primitive.triangles)
        if (is_mirrored[triangle[0]] && is_mirrored[triangle[1]] && is_mirrored[triangle[2]])
            std::swap(triangle[1], triangle[2]);
}

} // namespace vmlight::gltf
