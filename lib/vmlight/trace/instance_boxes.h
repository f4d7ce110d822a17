// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/instances.h>
#include <vmlight/trace/horizon.h>

#include <vector>

namespace vmlight {

/// Around each place of the instances of a mesh, in a scene: the boxes of its distinct mesh's box. Empty without.
std::vector<SceneBox> instance_boxes(const Mesh& mesh, const SceneFrame& frame);

/// False, with the reason in `error`, if one of them is too far away to be traced: as check_reach().
bool check_instance_reach(const Mesh& mesh, const SceneFrame& frame, std::string& error);

} // namespace vmlight
