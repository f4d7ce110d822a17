// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/light_color.h>

#include <vmlight/image/color_labels.h>

#include <algorithm>
#include <array>

namespace vmlight {

void LightColor::convert(std::vector<OIIO::ImageBuf>& cfem, int nthreads) const
{
    if (conversion)
        for (OIIO::ImageBuf& image : cfem)
            convert_color(image, conversion, spec.get_string_attribute("colorInteropID"), nthreads);
}

void LightColor::convert(std::vector<Sun>& suns) const
{
    for (Sun& sun : suns)
        if (conversion) {
            std::array<float, 3> rgb;
            std::copy(sun.color.begin(), sun.color.end(), rgb.begin());
            conversion(rgb.data(), 1);
            std::copy(rgb.begin(), rgb.end(), sun.color.begin());
        }
}

bool may_convert_light(const LightmapRecipe& recipe, const OIIO::ImageSpec& cfem)
{
    const ColorLabels labels = read_color_labels(cfem, cfem.format);
    return !recipe.cfem.empty() && (!recipe.colorspace.empty() || !labels.interop_id.empty() || labels.primaries);
}

bool describe_light(LightColor& dst, const LightmapRecipe& recipe, const OIIO::ImageSpec& cfem, std::string& error)
{
    dst = {};
    dst.spec = cfem;
    if (!may_convert_light(recipe, cfem))
        return true;
    const ColorLabels labels = read_color_labels(cfem, cfem.format);
    ColorSettings settings { recipe.colorconfig, recipe.colorspace, cfem.format };
    settings.labels_only = true;
    settings.working = !recipe.colorspace.empty() ? recipe.colorspace
        : !labels.interop_id.empty()              ? labels.interop_id
                                                  : labels.primaries->interop_id;
    return describe_scene_linear(dst.spec, dst.conversion, recipe.cfem, settings, dst.note, error, &dst.warnings);
}

std::string with_filter_prefix(const std::string& error)
{
    const std::string hint = "; set ";
    const size_t at = error.rfind(hint); // the last: a file's name may hold the same words
    return at == std::string::npos ? error : std::string(error).insert(at + hint.size(), "cfem_");
}

} // namespace vmlight
