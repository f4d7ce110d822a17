// SPDX-License-Identifier: Apache-2.0
/// `hero.lightmap` as an image: what OIIO looks for in lightmap.imageio.so.
#include "../readers.h"

#include <vmlight/version.h>

OIIO_PLUGIN_NAMESPACE_BEGIN

OIIO_PLUGIN_EXPORTS_BEGIN

OIIO_EXPORT int lightmap_imageio_version = OIIO_PLUGIN_VERSION;

OIIO_EXPORT const char* lightmap_imageio_library_version()
{
    return "vmlight " VMLIGHT_VERSION_STRING;
}

OIIO_EXPORT ImageInput* lightmap_input_imageio_create()
{
    return vmlight_create_reader("lightmap");
}

OIIO_EXPORT const char* lightmap_input_extensions[] = { "lightmap", nullptr };

OIIO_PLUGIN_EXPORTS_END

OIIO_PLUGIN_NAMESPACE_END
