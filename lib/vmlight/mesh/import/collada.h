// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vmlight {

/// Why the importer must not be given a Collada file of this text, or "": elements more than 100000 deep, down which it
/// goes by recursion; a scene of more than a million nodes once each node that another names (`instance_node`) is put
/// in its place, as assimp 5.2 does, by the names it goes by; a node under itself. That it is XML is not checked: of
/// broken XML as much is seen as comes before the break. Source: Khronos, Collada 1.4.1 specification, `instance_node`.
std::string collada_fault(const std::string& text);

} // namespace vmlight
