// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/lobe_lookup.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/cfem_lookup.h>

namespace vmlight {
namespace {

constexpr double kLobeTolerance = 1e-4;
// The vector kernel indexes floats with 32 bits.
constexpr int64_t kMostFloats = (int64_t(1) << 31) - 1;

int knot_of(int level)
{
    return level == 0 ? kCfemKnot : level == 1 ? 1 : level + 1;
}

// Store a knot in the maps of both its pairs.
void set_knot(LobeLookup& dst, int knot, int64_t place, const float* texel)
{
    const int64_t texels = int64_t(dst.pitch) * (dst.height + 2);
    if (knot > 0)
        std::copy_n(texel, 3, &dst.texels[size_t(kLobeFloats * ((knot - 1) * texels + place) + 3)]);
    if (knot + 1 < kLobeKnots)
        std::copy_n(texel, 3, &dst.texels[size_t(kLobeFloats * (knot * texels + place))]);
}

// The knots that the first level of a stack would fill.
void fill_first_knots(LobeLookup& dst, int64_t texels)
{
    const double share = (stack_lobe(0) - stack_lobe(1)) / (stack_lobe(2) - stack_lobe(1));
    for (int64_t i = 0; i < texels; ++i) {
        const float *hemisphere = &dst.texels[size_t(kLobeFloats * (texels + i))],
                    *narrower = &dst.texels[size_t(kLobeFloats * (3 * texels + i))];
        float between[3];
        for (int c = 0; c < 3; ++c)
            between[c] = float(double(hemisphere[c]) + share * (double(narrower[c]) - double(hemisphere[c])));
        set_knot(dst, 0, i, hemisphere);
        set_knot(dst, kCfemKnot, i, between);
    }
}

std::string level_fault(const OIIO::ImageSpec& first, const OIIO::ImageSpec& spec, int level)
{
    const float lobe = spec.get_float_attribute("vmlight:lobe", -1);
    std::string error;
    if (!(std::abs(lobe - stack_lobe(level)) < kLobeTolerance))
        return format("vmlight:lobe is {:g} instead of {:.4f}", lobe, stack_lobe(level));
    if (spec.width != first.width || spec.height != first.height)
        return format("{}x{} pixels, but level 0 has {}x{}", spec.width, spec.height, first.width, first.height);
    return check_cfem(spec, error) ? "" : error;
}

} // namespace

bool check_lobes(OIIO::cspan<OIIO::ImageBuf> levels, std::string& error)
{
    error.clear();
    if (levels.size() != kStackLevels) {
        error = format("a stack of {} levels instead of {}; make it again with makecfem --stack", levels.size(),
                       kStackLevels);
        return false;
    }
    const OIIO::ImageSpec& spec = levels[0].spec();
    const int64_t texels = (int64_t(spec.width) + 2) * (int64_t(spec.height) + 2);
    if (texels * kLobeFloats * (kLobeKnots - 1) > kMostFloats) {
        error = format("a stack of {} levels of {}x{} pixels is too large; the limit is 39 million pixels per level",
                       kStackLevels, spec.width, spec.height);
        return false;
    }
    for (int level = 0; level < kStackLevels && error.empty(); ++level)
        if (const std::string fault = level_fault(spec, levels[level].spec(), level); !fault.empty())
            error = format("level {} of the stack: {}", level, fault);
    return error.empty();
}

bool prepare_lobes(LobeLookup& dst, OIIO::cspan<OIIO::ImageBuf> levels, std::string& error)
{
    dst = {};
    if (!check_lobes(levels, error))
        return false;
    const OIIO::ImageSpec& spec = levels[0].spec();
    dst.width = spec.width;
    dst.height = spec.height;
    dst.pitch = spec.width + 2;
    const int64_t texels = int64_t(dst.pitch) * (dst.height + 2);
    dst.texels.resize(kLobeFloats * size_t(texels) * (kLobeKnots - 1) + 2);
    const bool is_of_strands = kernel_of(spec) == kStrandKernel;
    for (int level = 0; level < kStackLevels; ++level) {
        CfemLookup map;
        if (!prepare_cfem(map, levels[level], error)) {
            error = format("level {} of the stack: {}", level, error);
            return false;
        }
        dst.largest = std::max(dst.largest, map.largest);
        if (level == 0)
            std::copy_n(map.brightest, 4, dst.brightest);
        for (int64_t i = 0; i < texels && !(is_of_strands && level == 0); ++i) {
            const float* texel = &map.texels[4 * size_t(i)];
            set_knot(dst, knot_of(level), i, texel);
            if (level == 0)
                set_knot(dst, 0, i, &map.texels[4 * size_t(map.mean_texel())]);
        }
    }
    if (is_of_strands)
        fill_first_knots(dst, texels);
    return true;
}

} // namespace vmlight
