// SPDX-License-Identifier: Apache-2.0
/// Bytes as what assimp might import from a mesh file.
#pragma once

#include "bytes.h"

#include <assimp/scene.h>

#include <memory>

namespace vmlight::fuzz {

inline aiVector3D vector_of(Bytes& bytes)
{
    const float x = bytes.number(), y = bytes.number(), z = bytes.number();
    return { x, y, z };
}

inline std::unique_ptr<aiVector3D[]> vectors_of(Bytes& bytes, unsigned count)
{
    auto vectors = std::make_unique<aiVector3D[]>(count);
    std::generate_n(vectors.get(), count, [&] { return vector_of(bytes); });
    return vectors;
}

/// Up to 16 vertices, with or without normals and texture coordinates, and up to 31 faces, most of them triangles.
inline aiMesh* part_of(Bytes& bytes)
{
    auto part = std::make_unique<aiMesh>();
    const uint8_t has = bytes.byte(), count = bytes.byte();
    part->mName = bytes.text(8);
    part->mNumVertices = 1 + (count + 15) % 16;
    part->mVertices = vectors_of(bytes, part->mNumVertices).release();
    if (has & 1)
        part->mNormals = vectors_of(bytes, part->mNumVertices).release();
    for (unsigned set = 0; set < 2; ++set)
        if (has >> 1 & (1 + set))
            part->mTextureCoords[set] = vectors_of(bytes, part->mNumVertices).release();
    part->mNumFaces = unsigned(bytes.below(32));
    part->mFaces = new aiFace[part->mNumFaces];
    for (unsigned f = 0; f < part->mNumFaces; ++f) {
        aiFace& face = part->mFaces[f];
        const uint8_t first = bytes.byte();
        face.mNumIndices = first < 240 ? 3 : first % 5;
        face.mIndices = new unsigned[face.mNumIndices + 1] {};
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            const uint8_t index = k == 0 ? first : bytes.byte();
            face.mIndices[k] = index % part->mNumVertices;
        }
    }
    part->mMaterialIndex = bytes.byte();
    return part.release();
}

/// A chain of up to three nodes, each with all parts, with or without a transform.
inline std::unique_ptr<aiScene> imported_of(Bytes& bytes)
{
    auto imported = std::make_unique<aiScene>();
    imported->mNumMeshes = unsigned(1 + bytes.below(2));
    imported->mMeshes = new aiMesh* [imported->mNumMeshes] {};
    for (unsigned m = 0; m < imported->mNumMeshes; ++m)
        imported->mMeshes[m] = part_of(bytes);
    imported->mRootNode = new aiNode;
    aiNode* node = imported->mRootNode;
    for (size_t depth = bytes.below(3);; --depth) {
        if (bytes.flag())
            for (unsigned i = 0; i < 4; ++i)
                for (unsigned j = 0; j < 4; ++j)
                    node->mTransformation[i][j] = bytes.number();
        node->mNumMeshes = imported->mNumMeshes;
        node->mMeshes = new unsigned[2] { 0, 1 };
        if (depth == 0)
            break;
        auto* child = new aiNode;
        node->addChildren(1, &child);
        node = child;
    }
    if (bytes.flag()) {
        imported->mMetaData = aiMetadata::Alloc(1);
        imported->mMetaData->Set(0, "UpAxis", int(bytes.below(4)));
    }
    return imported;
}

} // namespace vmlight::fuzz
