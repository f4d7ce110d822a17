// SPDX-License-Identifier: Apache-2.0
/// Whether an image is a lightmap, and whose: what would otherwise be shown or packed as light without a word.
#pragma once

#include <OpenImageIO/imageio.h>

#include <string>

namespace vmlight {

/// Why an image of this header is no lightmap, or "": `vmlight:stage` names another stage. Without one it may be light
/// of another renderer.
std::string lightmap_fault(const OIIO::ImageSpec& spec);

/// A warning, without the name, of a lightmap that was lit by a visibility map of another mesh than `vismap` is of; ""
/// if either does not say of which.
std::string other_mesh_warning(const OIIO::ImageSpec& lightmap, const OIIO::ImageSpec& vismap);

} // namespace vmlight
