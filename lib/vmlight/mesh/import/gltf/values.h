// SPDX-License-Identifier: Apache-2.0
/// Members of extension objects.
#pragma once

#include <vmlight/mesh/tinygltf.h>

#include <cstddef>
#include <limits>
#include <string>

namespace vmlight::gltf {

/// A number of `object`, or `otherwise` if it has none of this name, or something else.
inline double number_of(const tinygltf::Value& object, const char* name, double otherwise)
{
    if (!object.IsObject() || !object.Has(name) || !object.Get(name).IsNumber())
        return otherwise;
    return object.Get(name).GetNumberAsDouble();
}

/// As number_of(), for an index or a size: -1 if it is not a whole number from 0 to 2^31 - 1.
inline int index_of(const tinygltf::Value& object, const char* name, int otherwise = -1)
{
    const double number = number_of(object, name, otherwise);
    const bool is_index = number >= 0 && number <= std::numeric_limits<int>::max() && number == double(int(number));
    return is_index ? int(number) : -1;
}

inline std::string string_of(const tinygltf::Value& object, const char* name, const char* otherwise)
{
    if (!object.IsObject() || !object.Has(name) || !object.Get(name).IsString())
        return otherwise;
    return object.Get(name).Get<std::string>();
}

} // namespace vmlight::gltf
