// SPDX-License-Identifier: Apache-2.0
/// `hero.lightmap` as an image: what OIIO looks for in lightmap.imageio.so.
#include <vmlight/stage_input.h>

OIIO_PLUGIN_NAMESPACE_BEGIN

namespace {

class LightmapInput final : public vmlight::StageInput
{
public:
    LightmapInput()
        : StageInput("lightmap")
    {
    }
};

} // namespace

OIIO_PLUGIN_EXPORTS_BEGIN

OIIO_EXPORT int lightmap_imageio_version = OIIO_PLUGIN_VERSION;

OIIO_EXPORT const char* lightmap_imageio_library_version()
{
    return "vmlight " VMLIGHT_VERSION;
}

OIIO_EXPORT ImageInput* lightmap_input_imageio_create()
{
    return new LightmapInput;
}

OIIO_EXPORT const char* lightmap_input_extensions[] = { "lightmap", nullptr };

OIIO_PLUGIN_EXPORTS_END

OIIO_PLUGIN_NAMESPACE_END
