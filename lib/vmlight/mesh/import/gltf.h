// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vmlight {

/// Why the importer must not be given a glTF or GLB of these bytes, or "": brackets more than 1000 deep, a node under
/// two others (assimp 5.2 copies it, and doubles memory at each of a chain of such) or under itself; a scene whose
/// roots have more than a million nodes under them, since it may name a root often. What is not JSON is the importer's
/// to refuse. Source: Khronos, glTF 2.0 specification, 3.5.2 (node hierarchy) and 4.4 (GLB).
std::string gltf_fault(const std::string& bytes);

} // namespace vmlight
