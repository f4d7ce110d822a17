// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/uv/unwrap.h>

#include <string>

namespace vmlight {

/// What an atlas is like, for the user.
std::string unwrap_line(const UnwrapReport& report, const UnwrapParams& params);
/// Which triangles have no place in it, or "".
std::string unwrap_warning(const UnwrapReport& report);

} // namespace vmlight
