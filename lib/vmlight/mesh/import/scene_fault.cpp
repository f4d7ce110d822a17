// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/scene_fault.h>

#include <OpenImageIO/strutil.h>

#include <assimp/scene.h>

#include <algorithm>

namespace vmlight {

std::string mesh_scene_fault(const aiScene& scene)
{
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& part = *scene.mMeshes[m];
        for (unsigned f = 0; f < part.mNumFaces; ++f)
            for (unsigned corner = 0; corner < part.mFaces[f].mNumIndices; ++corner)
                if (const unsigned vertex = part.mFaces[f].mIndices[corner]; vertex >= part.mNumVertices)
                    return OIIO::Strutil::fmt::format("face {} of \"{}\" has vertex {}, of {}", f, part.mName.C_Str(),
                                                      vertex, part.mNumVertices);
    }
    return "";
}

void correct_primitive_types(aiScene& scene)
{
    // What has no corners is not cut either, and no type at all would have assimp look for itself.
    constexpr unsigned kTypes[] = { aiPrimitiveType_POINT, aiPrimitiveType_POINT, aiPrimitiveType_LINE,
                                    aiPrimitiveType_TRIANGLE, aiPrimitiveType_POLYGON };
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        aiMesh& part = *scene.mMeshes[m];
        part.mPrimitiveTypes = 0;
        for (unsigned f = 0; f < part.mNumFaces; ++f)
            part.mPrimitiveTypes |= kTypes[std::min(part.mFaces[f].mNumIndices, 4u)];
    }
}

} // namespace vmlight
