// SPDX-License-Identifier: Apache-2.0
/// What every part of the glTF reader uses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace vmlight::gltf {

/// Why a file cannot be read, without its path. Thrown while a file is read; see without_errors().
struct Error : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/// Run `read`. Returns false, with the reason in `error`, if it throws an Error or one of the libraries that it uses
/// throws; lack of memory passes.
bool without_errors(std::string& error, const std::function<void()>& read);

/// Bytes that something else owns.
struct Bytes
{
    const uint8_t* data = nullptr;
    size_t size = 0;
};

} // namespace vmlight::gltf
