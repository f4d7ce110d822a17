// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/mesh/import/assimp_importer.h>

#include <assimp/scene.h>

namespace vmlight {
namespace {

using Imath::V2f;
using Imath::V3d;

// Assimp's matrices multiply column vectors, Imath's multiply row vectors: transposed here, composed in double.
Imath::M44d matrix_of(const aiMatrix4x4& m)
{
    return Imath::M44d(m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4);
}

V3d to_double(const aiVector3D& v)
{
    return V3d(v.x, v.y, v.z);
}

bool is_z_up(const aiScene& imported)
{
    int axis = 1;
    if (imported.mMetaData)
        imported.mMetaData->Get("UpAxis", axis);
    return axis == 2;
}

void append_part(MeshBuilder& dst, const aiMesh& part, const Imath::M44d& to_object, uint32_t node)
{
    const unsigned set = unsigned(dst.params().uv_set);
    dst.begin_part(part.mName.C_Str(), to_object, node);
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
        V2f uv(0);
        if (part.HasTextureCoords(set))
            uv = V2f(part.mTextureCoords[set][i].x, part.mTextureCoords[set][i].y);
        dst.add_vertex(to_double(part.mVertices[i]), part.HasNormals() ? to_double(part.mNormals[i]) : V3d(0),
                       part.HasTextureCoords(set) ? &uv : nullptr);
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
        const aiFace& face = part.mFaces[i];
        if (face.mNumIndices == 3) // not a point or a line
            dst.add_triangle({ face.mIndices[0], face.mIndices[1], face.mIndices[2] }, part.mMaterialIndex);
    }
}

void append_node(MeshBuilder& dst, const aiScene& imported, const aiNode& node, const Imath::M44d& parent_to_object,
                 int parent)
{
    const Imath::M44d to_object = matrix_of(node.mTransformation) * parent_to_object;
    const uint32_t index = dst.add_node(node.mName.C_Str(), parent);
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
        append_part(dst, *imported.mMeshes[node.mMeshes[i]], to_object, index);
    for (unsigned i = 0; i < node.mNumChildren; ++i)
        append_node(dst, imported, *node.mChildren[i], to_object, int(index));
}

} // namespace

void append_imported(MeshBuilder& dst, const aiScene& imported, const std::string& folder)
{
    for (Material& material : materials_of(imported, folder))
        dst.add_material(std::move(material));
    append_node(dst, imported, *imported.mRootNode, dst.root_transform(is_z_up(imported)), -1);
}

std::string face_error(const aiScene& imported)
{
    for (unsigned m = 0; m < imported.mNumMeshes; ++m) {
        const aiMesh& part = *imported.mMeshes[m];
        for (unsigned f = 0; f < part.mNumFaces; ++f)
            for (unsigned corner = 0; corner < part.mFaces[f].mNumIndices; ++corner)
                if (const unsigned vertex = part.mFaces[f].mIndices[corner]; vertex >= part.mNumVertices)
                    return format("face {} of \"{}\" uses vertex {}, but there are only {}", f, part.mName.C_Str(),
                                  vertex, part.mNumVertices);
    }
    return "";
}

} // namespace vmlight
