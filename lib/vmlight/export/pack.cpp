// SPDX-License-Identifier: Apache-2.0
#include <vmlight/export/pack.h>

#include <vmlight/base/format.h>

#include <algorithm>

namespace vmlight {
namespace {

std::string base_fault(const OIIO::ImageSpec& base, const OIIO::ImageSpec& occlusion, const OcclusionLayout& layout)
{
    const int least = layout.channels == 4 ? 4 : 3;
    if (base.nchannels < least || base.nchannels > 4)
        return format("{} channels; a texture to pack into has {}", base.nchannels, least == 4 ? "4" : "3 or 4");
    if (base.width != occlusion.width || base.height != occlusion.height)
        return format("{}x{}, but the map is {}x{}: resize it, or bake a map of its size", base.width, base.height,
                      occlusion.width, occlusion.height);
    return "";
}

} // namespace

bool pack_occlusion(OIIO::ImageBuf& dst, const OIIO::ImageBuf& occlusion, const OcclusionLayout& layout,
                    const OIIO::ImageBuf* base, std::string& error)
{
    error = base ? base_fault(base->spec(), occlusion.spec(), layout) : "";
    if (!error.empty())
        return false;
    const int channels = base ? base->nchannels() : layout.channels;
    dst = OIIO::ImageBuf(OIIO::ImageSpec(occlusion.spec().width, occlusion.spec().height, channels, OIIO::TypeFloat));
    auto* to = static_cast<float*>(dst.localpixels());
    const auto* from = base ? static_cast<const float*>(base->localpixels()) : nullptr;
    const auto* v = static_cast<const float*>(occlusion.localpixels());
    for (size_t i = 0; i < occlusion.spec().image_pixels(); ++i, to += channels) {
        std::copy_n(from ? from + i * size_t(channels) : layout.others.data(), channels, to);
        to[layout.channel] = v[i];
    }
    return true;
}

} // namespace vmlight
