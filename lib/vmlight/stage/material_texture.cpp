// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/material_texture.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/image_file.h>
#include <vmlight/image/primaries.h>
#include <vmlight/stage/material_image.h>

#include <limits>

namespace vmlight {
bool read_material_texture(OIIO::ImageBuf& dst, std::array<int, 3>& index, const MaterialTexture& texture,
                           const ColorSettings& settings, int nthreads, std::string& error)
{
    const bool is_file = !texture.embedded && texture.length == 0;
    OIIO::TypeDesc stored;
    if (!(is_file ? read_image(dst, texture.path, error)
                  : MaterialImage::read_all(dst, texture, std::numeric_limits<int>::max(), error, &stored)))
        return false;
    ColorSettings own = settings;
    own.stored = is_file ? dst.nativespec().format : stored;
    std::string note;
    if (find_color_channels(dst.spec(), index, error)
        && to_scene_linear(dst, is_file ? texture.path : "", own, note, error, nthreads))
        return true;
    error = format("\"{}\": {}", texture.path, error);
    return false;
}

bool find_factor_conversion(ColorConversion& dst, const ColorSettings& settings, std::string& error)
{
    OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeFloat);
    tag_scene_linear(spec, "lin_rec709_scene");
    ColorSettings own = settings;
    own.stored = OIIO::TypeFloat;
    std::string note;
    return describe_scene_linear(spec, dst, "", own, note, error);
}

} // namespace vmlight
