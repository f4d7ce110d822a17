// SPDX-License-Identifier: Apache-2.0
/// `hero.vismap` as an image: what OIIO looks for in vismap.imageio.so.
#include "../readers.h"

#include <vmlight/version.h>

OIIO_PLUGIN_NAMESPACE_BEGIN

OIIO_PLUGIN_EXPORTS_BEGIN

OIIO_EXPORT int vismap_imageio_version = OIIO_PLUGIN_VERSION;

OIIO_EXPORT const char* vismap_imageio_library_version()
{
    return "vmlight " VMLIGHT_VERSION_STRING;
}

OIIO_EXPORT ImageInput* vismap_input_imageio_create()
{
    return vmlight_create_reader("vismap");
}

OIIO_EXPORT const char* vismap_input_extensions[] = { "vismap", nullptr };

OIIO_PLUGIN_EXPORTS_END

OIIO_PLUGIN_NAMESPACE_END
