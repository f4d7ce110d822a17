// SPDX-License-Identifier: Apache-2.0
/// What every part of the glTF reader uses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace vmlight::gltf {

/// Why a file cannot be read, without its path. Thrown in this room alone, and caught by read_gltf().
struct Error : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/// Bytes that something else owns.
struct Bytes
{
    const uint8_t* data = nullptr;
    size_t size = 0;
};

} // namespace vmlight::gltf
