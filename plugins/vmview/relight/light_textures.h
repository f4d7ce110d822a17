// SPDX-License-Identifier: Apache-2.0
/// An environment's light on the graphics card, as the models ao, paper, lobe and sh look it up.
#pragma once

#include "../gl/objects.h"

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight::view {

struct LightTextures
{
    Texture cfem; ///< CfemLookup::texels
    Texture lobes; ///< a layer for each knot of LobeLookup, with its frame; none without a stack
    int width = 0, height = 0; ///< of both, without frames
    float brightest[3] = { 0, 0, 0 }; ///< of the CFEM

    /// Load the images of a stack, or a single CFEM. False, with the reason in `error`, if make_lightmap() would refuse
    /// them.
    bool load(const std::vector<OIIO::ImageBuf>& images, std::string& error);
};

} // namespace vmlight::view
