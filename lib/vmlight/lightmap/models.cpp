// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/lightmap/model_cells.h>
#include <vmlight/lightmap/model_lobe.h>
#include <vmlight/lightmap/model_mask.h>
#include <vmlight/lightmap/model_paper.h>
#include <vmlight/lightmap/model_sh.h>

#include <OpenImageIO/strutil.h>

#include <array>

namespace vmlight {
namespace {

// Name, phrase, light, rank, strand rank, basis, added channel, whole numbers, unread, channels, is_baked, prepare.
constexpr ModelEntry kModels[] = {
    { "ao", "ambient occlusion: V times the light around the normal", ModelLight::cfem, 0, 1, "", "normal", 0, 0,
      ao_model_channels, nullptr, prepare_paper },
    { "paper", "V times the light around the mean visible direction", ModelLight::cfem, 1, 0, "", "", 0, 0,
      paper_model_channels, nullptr, prepare_paper },
    { "lobe", "like paper, with a lobe as wide as the visible part of the sky", ModelLight::lobes, 2, 2, "", "", 0, 0,
      lobe_model_channels, nullptr, prepare_lobe },
    { "sh", "light and visibility in spherical harmonics", ModelLight::radiance, 3, 3, "sh", "", 0, 0,
      sh_model_channels, has_sh, prepare_sh },
    { "mask", "light within the visible range of heights in each of 16 longitudes", ModelLight::radiance, 4, 0, "mask",
      "", kMaskFloats, 3, mask_model_channels, has_mask, prepare_mask },
    { "cells", "light of 144 cells of the sphere, each weighted by visibility", ModelLight::radiance, 5, 0, "cells", "",
      kCellsFloats, 3, cells_model_channels, has_cells, prepare_cells },
};

bool is_of_strands(const OIIO::ImageSpec& vismap)
{
    return kernel_of(vismap) == kStrandKernel;
}

int rank_of(const ModelEntry& entry, const OIIO::ImageSpec& vismap)
{
    return is_of_strands(vismap) ? entry.strand_rank : entry.rank;
}

std::string strand_models()
{
    std::vector<std::string> names;
    for (const ModelEntry& entry : kModels)
        if (entry.strand_rank > 0)
            names.emplace_back(entry.name);
    return OIIO::Strutil::join(names, ", ");
}

const ModelEntry& best_entry(const OIIO::ImageSpec& vismap, bool has_stack)
{
    const ModelEntry* best = nullptr;
    for (const ModelEntry& entry : kModels) {
        const bool has_light = has_stack || entry.light == ModelLight::cfem;
        if (rank_of(entry, vismap) > (best ? rank_of(*best, vismap) : 0) && has_light
            && (!entry.is_baked || entry.is_baked(vismap)))
            best = &entry;
    }
    return *best;
}

std::string bake_flags(const ModelEntry& entry)
{
    return *entry.basis ? format("--basis {}", entry.basis) : format("--channels {}", entry.added_channel);
}

} // namespace

OIIO::cspan<ModelEntry> model_entries()
{
    return kModels;
}

const ModelEntry* find_model_entry(const std::string& name)
{
    for (const ModelEntry& entry : kModels)
        if (name == entry.name)
            return &entry;
    return nullptr;
}

Choices model_choices()
{
    Choices choices { { { "auto", "the most accurate model that the map and the light allow" } } };
    for (const ModelEntry& entry : kModels)
        choices.choices.push_back({ entry.name, entry.phrase });
    return choices;
}

bool reads_radiance(const std::string& model)
{
    const ModelEntry* entry = find_model_entry(model);
    return entry && entry->light == ModelLight::radiance;
}

std::string with_suns(const std::string& model)
{
    return model + "+suns";
}

bool choose_model(ShadingModel& dst, const LightmapParams& params, const OIIO::ImageSpec& vismap, bool has_stack,
                  std::string& error)
{
    std::array<int, 4> ignored;
    if (!find_vismap_channels(vismap, ignored, error))
        return false;
    const ModelEntry* named = find_model_entry(params.model);
    const ModelEntry& entry = named ? *named : best_entry(vismap, has_stack);
    if (is_of_strands(vismap) && entry.strand_rank == 0) {
        error = format("model {} is of surfaces, and the visibility map of strands: use one of {}", entry.name,
                       strand_models());
        return false;
    }
    dst = { entry.name, entry.light, entry.channels(vismap), &entry };
    for (const std::string& name : dst.channels)
        if (vismap.channelindex(name) < 0) {
            error = format("model {} needs channel \"{}\", which makevismap {} adds; found {}", entry.name, name,
                           bake_flags(entry), OIIO::Strutil::join(vismap.channelnames, ", "));
            return false;
        }
    return true;
}

std::string kernel_fault(const ShadingModel& model, const OIIO::ImageSpec& vismap, const OIIO::ImageSpec& light)
{
    const std::string map = kernel_of(vismap), filtered = kernel_of(light);
    return model.light == ModelLight::radiance || map == filtered
        ? ""
        : format("filtered by the kernel {}, and the visibility map needs {}: filter the environment by makecfem "
                 "--kernel {}{}",
                 filtered, map, map, model.light == ModelLight::lobes ? " --stack" : "");
}

} // namespace vmlight
