// SPDX-License-Identifier: Apache-2.0
/// What the three readers share in a process: one library, so that a map that the vismap reader baked is there when the
/// lightmap reader wants it. Only this function leads into it.
#pragma once

#include <OpenImageIO/imageio.h>

/// A reader of the recipes of `stage`, which must be a literal: "vismap", "cfem" or "lightmap".
extern "C" __attribute__((visibility("default"))) OIIO::ImageInput* vmlight_create_reader(const char* stage);
