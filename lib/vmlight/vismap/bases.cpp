// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/vismap/basis.h>
#include <vmlight/vismap/basis_grid.h>
#include <vmlight/vismap/basis_sh.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight {
namespace {

std::vector<std::string> no_channels(const VismapParams&)
{
    return {};
}

// Name, phrase, own parameter, needs_normal, whole_numbers, has_strands, channels, accumulator.
constexpr VisibilityBasis kBases[] = {
    { "vector", "only visibility and mean direction", "", false, false, true, no_channels, nullptr },
    { "sh", "spherical harmonics of the visible cosine lobe, --order bands", "order", false, false, true, sh_channels,
      make_sh_accumulator },
    { "mask", "for each of 16 longitudes, the visible range of heights and its density", "", true, true, false,
      mask_channels, make_mask_accumulator },
    { "cells", "how much of each of 144 cells of the sphere is visible", "", true, true, false, cells_channels,
      make_cells_accumulator },
};

} // namespace

OIIO::cspan<VisibilityBasis> visibility_bases()
{
    return kBases;
}

const VisibilityBasis& find_basis(const std::string& name)
{
    for (const VisibilityBasis& basis : kBases)
        if (name == basis.name)
            return basis;
    return kBases[0];
}

Choices basis_choices()
{
    Choices choices;
    for (const VisibilityBasis& basis : kBases)
        choices.choices.push_back({ basis.name, basis.phrase });
    return choices;
}

std::vector<std::string> basis_channels(const VismapParams& params)
{
    return find_basis(params.basis).channels(params);
}

std::unique_ptr<BasisAccumulator> make_accumulator(const VismapParams& params)
{
    const VisibilityBasis& basis = find_basis(params.basis);
    return basis.accumulator ? basis.accumulator(params) : nullptr;
}

std::string unused_basis_parameter(const VismapParams& params, const std::string& key)
{
    for (const VisibilityBasis& basis : kBases)
        if (key == basis.parameter && params.basis != basis.name)
            return format("only the basis {} uses it", basis.name);
    return "";
}

bool holds_whole_numbers(const std::string& channel)
{
    return std::any_of(std::begin(kBases), std::end(kBases), [&](const VisibilityBasis& basis) {
        return basis.whole_numbers && OIIO::Strutil::starts_with(channel, format("{}.", basis.name));
    });
}

std::string half_fault(const OIIO::ImageSpec& spec)
{
    for (const std::string& channel : spec.channelnames)
        if (holds_whole_numbers(channel))
            return format("channel {} holds whole numbers up to 2^24, and half is exact only up to 2048: write float",
                          channel);
    return "";
}

bool VismapParams::has(const std::string& channel) const
{
    if (channel == "normal" && find_basis(basis).needs_normal)
        return true;
    return std::find(channels.begin(), channels.end(), channel) != channels.end();
}

} // namespace vmlight
