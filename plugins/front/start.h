// SPDX-License-Identifier: Apache-2.0
/// Executables that replace this process.
#pragma once

#include <string>

namespace vmlight::front {

/// The folder of this process's executable, through links; "" if it cannot be known.
std::string own_folder();

/// Become the executable `path`, with the arguments, environment, descriptors and process of this one. Returns only on
/// failure, with the reason.
std::string start(const std::string& path, const char** argv);

/// The same with the executable `name` of $PATH.
std::string start_from_path(const std::string& name, const char** argv);

} // namespace vmlight::front
