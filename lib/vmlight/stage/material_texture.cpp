// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/material_texture.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/image_file.h>
#include <vmlight/image/primaries.h>
#include <vmlight/stage/material_image.h>

namespace vmlight {
namespace {

using OIIO::ImageBuf;

bool read_embedded(ImageBuf& dst, const MaterialTexture& texture, std::string& error)
{
    MaterialImage image;
    if (!image.open(texture, error))
        return false;
    OIIO::ImageSpec spec = image.spec();
    const OIIO::TypeDesc stored = spec.format;
    spec.set_format(OIIO::TypeFloat);
    dst.reset(spec);
    if (!image.read(0, spec.nchannels, static_cast<float*>(dst.localpixels()), error))
        return false;
    dst.specmod().attribute("vmlight:stored", int(stored.basetype));
    return true;
}

} // namespace

bool read_material_texture(ImageBuf& dst, std::array<int, 3>& index, const MaterialTexture& texture,
                           const ColorSettings& settings, int nthreads, std::string& error)
{
    const bool is_file = !texture.embedded && texture.length == 0;
    if (!(is_file ? read_image(dst, texture.path, error) : read_embedded(dst, texture, error)))
        return false;
    ColorSettings own = settings;
    own.stored = is_file ? dst.nativespec().format
                         : OIIO::TypeDesc(OIIO::TypeDesc::BASETYPE(dst.spec().get_int_attribute("vmlight:stored")));
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
