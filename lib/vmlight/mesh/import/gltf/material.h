// SPDX-License-Identifier: Apache-2.0
/// The materials of a glTF.
#pragma once

namespace vmlight::gltf {

class Document;

/// Add every material of the document to its builder, in the file's order, and a last one without a name for primitives
/// that have none. Textures that cannot be found are warned of. Of KHR_materials_pbrSpecularGlossiness, its diffuse
/// colour is the base colour.
/// Source: Khronos, glTF 2.0 specification, 3.9 (materials) and 3.8 (textures).
void add_materials(Document& document);

} // namespace vmlight::gltf
