// SPDX-License-Identifier: Apache-2.0
/// The numbers of accessors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vmlight::gltf {

class Document;

/// The elements of an accessor, `components` numbers each.
struct Numbers
{
    size_t count = 0;
    size_t components = 0;
    std::vector<double> values;

    const double* operator[](size_t element) const { return values.data() + element * components; }
};

/// The elements of an accessor in double: of every component type, normalized ones divided by their largest value and
/// not below -1, with strides, offsets and sparse values, zeros if it has no buffer view.
///
/// @param type     tinygltf's constant of the only type that is accepted: TINYGLTF_TYPE_VEC3
/// @param count    how many elements there must be; any number if 0
/// @param what     what is read, for messages: "POSITION"
///
/// Throws Error if there is no such accessor, it is of another type, of another count, or extends past its buffer view.
/// Source: Khronos, glTF 2.0 specification, 3.6.2 (accessors) and 3.11 (normalized integers).
Numbers read_accessor(Document& document, int accessor, int type, size_t count, const std::string& what);

/// The indices of a primitive, of unsigned integers of any size.
std::vector<uint32_t> read_indices(Document& document, int accessor);

/// Whether the accessor's numbers are integers, as KHR_mesh_quantization allows; and normalized.
bool has_integers(Document& document, int accessor);
bool has_normalized_integers(Document& document, int accessor);

} // namespace vmlight::gltf
