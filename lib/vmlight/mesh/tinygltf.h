// SPDX-License-Identifier: Apache-2.0
/// tinygltf under a name of its own. Debian's libdraco exports the symbols of an older tinygltf, which has other
/// layouts: linked beside libtinygltf, or in a host application, either may be found first. So the header's own
/// implementation is compiled here (tinygltf.cpp), and no symbol is shared.
#pragma once

#define tinygltf vmlight_tinygltf
// No image is decoded, and files are read by those who call it.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_INCLUDE_JSON

#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#undef tinygltf

namespace vmlight {
namespace tinygltf = vmlight_tinygltf;
}
