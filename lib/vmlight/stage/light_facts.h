// SPDX-License-Identifier: Apache-2.0
/// Facts of lightmaps and frames alike.
#pragma once

#include <vmlight/effects/facts.h>
#include <vmlight/math/rotation.h>

#include <OpenImageIO/imagebuf.h>

namespace vmlight {

/// The angle of a rotation, in degrees, exact near 0.
double rotation_degrees(const Rotation& rotation);

/// Set LightFacts::lit and ::shadowed of a map. What cannot be read is not counted: whoever lights it reports it.
void find_visibility_facts(LightFacts& dst, const OIIO::ImageBuf& vismap);

} // namespace vmlight
