// SPDX-License-Identifier: Apache-2.0
/// KHR_texture_transform: of textures, and of UVs that were quantized.
#pragma once

#include <vmlight/mesh/tinygltf.h>

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <vector>

namespace vmlight::gltf {

class Document;

/// The transform of a texture's UVs, v down, for row vectors: the identity if there is none.
/// @param extensions   of the texture's entry in a material
/// @param uv_set       set to the transform's own UV set, if it has one
Imath::M33d texture_transform(const tinygltf::ExtensionMap& extensions, int& uv_set);

/// Turn integers back to the UVs that they were quantized from. Tools that quantize UVs to integers (gltfpack) write
/// how to undo it as the KHR_texture_transform of the material's textures: it is applied to integers that are not
/// normalized, and to normalized ones of gltfpack. A transform of other UVs moves the texture, not the layout of the
/// baked map, and is not applied. The user is warned of each.
///
/// @param uvs      of the set `uv_set`, v down
void restore_quantized_uvs(std::vector<Imath::V2d>& uvs, Document& document, const tinygltf::Primitive& primitive,
                           int uv_set);

} // namespace vmlight::gltf
