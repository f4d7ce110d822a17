// SPDX-License-Identifier: Apache-2.0
/// Facts of lightmaps and frames alike.
#pragma once

#include <vmlight/effects/facts.h>
#include <vmlight/math/rotation.h>
#include <vmlight/stage/bounce_shading.h>
#include <vmlight/stage/make_options.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// The angle of a rotation, in degrees, exact near 0.
double rotation_degrees(const Rotation& rotation);

/// Set LightFacts::lit and ::shadowed of a map. What cannot be read is not counted: whoever lights it reports it.
void find_visibility_facts(LightFacts& dst, const OIIO::ImageBuf& vismap);

/// Set LightFacts::traced_rays and ::traced_points, if the other facts call for a bounce and the options ask for the
/// table. False, with the reason in `error`, as BounceShading::forecast().
///
/// @param bounce   nullptr if there is none
bool find_bounce_facts(LightFacts& dst, BounceShading* bounce, const OIIO::ImageBuf& vismap, const MakeOptions& options,
                       std::string& error);

} // namespace vmlight
