// SPDX-License-Identifier: Apache-2.0
// The implementation of tinygltf, which nothing else may compile.
#include <fstream> // which it uses and does not include

#define TINYGLTF_IMPLEMENTATION
#include <vmlight/mesh/tinygltf.h>
