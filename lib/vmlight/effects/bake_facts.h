// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/effects/facts.h>
#include <vmlight/vismap/baker.h>

namespace vmlight {

/// The facts of a bake that is prepared. Traces no ray; `udim_given` and `half` are left to the caller.
BakeFacts bake_facts(const BakeScene& scene, const VismapBaker& baker, int64_t covered);

} // namespace vmlight
