// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vmlight {

/// Why the importer must not be given a Collada file of this text, or "": elements more than 100000 deep, down which it
/// goes by recursion. That it is XML is not checked.
std::string collada_fault(const std::string& text);

} // namespace vmlight
