// SPDX-License-Identifier: Apache-2.0
/// `hero.cfem` as an image: what OIIO looks for in cfem.imageio.so.
#include "../readers.h"

#include <vmlight/version.h>

OIIO_PLUGIN_NAMESPACE_BEGIN

OIIO_PLUGIN_EXPORTS_BEGIN

OIIO_EXPORT int cfem_imageio_version = OIIO_PLUGIN_VERSION;

OIIO_EXPORT const char* cfem_imageio_library_version()
{
    return "vmlight " VMLIGHT_VERSION_STRING;
}

OIIO_EXPORT ImageInput* cfem_input_imageio_create()
{
    return vmlight_create_reader("cfem");
}

OIIO_EXPORT const char* cfem_input_extensions[] = { "cfem", nullptr };

OIIO_PLUGIN_EXPORTS_END

OIIO_PLUGIN_NAMESPACE_END
