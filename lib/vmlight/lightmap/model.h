// SPDX-License-Identifier: Apache-2.0
/// The shading models of make_lightmap(). A model is one row of the table in models.cpp, with its functions in its own
/// file (model_lobe.cpp, ...); everything else asks the table.
#pragma once

#include <vmlight/lightmap/lightmap.h>
#include <vmlight/lightmap/model_shader.h>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/span.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// The images of a stack that a model looks light up in.
enum class ModelLight
{
    cfem, ///< the first, or a single CFEM
    lobes, ///< all but the last
    radiance ///< the last, or the environment as make_radiance() reduces it
};

struct ModelEntry
{
    /// The word for LightmapParams::model.
    const char* name;
    /// What it does, for help texts.
    const char* phrase;
    ModelLight light;
    /// `auto` takes the model of the highest rank that map and light allow. 0: never chosen by `auto`.
    int rank;
    /// The same for maps of strands; 0: the model is of surfaces alone.
    int strand_rank;
    /// The bake that stores its channels: VismapParams::basis, and the word to add to VismapParams::channels; or "".
    const char *basis, *added_channel;
    /// How many of its channels, counted from the last, hold whole numbers below 2^24.
    int whole_numbers;
    /// Floats of a texel that it is handed and does not read.
    int unread;
    /// Channels of the visibility map in the order that the model reads them. `vismap` says which there are, for a
    /// model that reads a variable number.
    std::vector<std::string> (*channels)(const OIIO::ImageSpec& vismap);
    /// Whether the map was baked for this model, so that `auto` may choose it; nullptr if every map will do.
    bool (*is_baked)(const OIIO::ImageSpec& vismap);
    /// Prepare the light. nullptr, with the reason in `error`, if an image is not what the model needs.
    std::unique_ptr<ModelShader> (*prepare)(const ModelInput& input, std::string& error);
};

/// The table, from the cheapest model to the most accurate.
OIIO::cspan<ModelEntry> model_entries();
/// The row of that name; nullptr if there is none (`auto` has none).
const ModelEntry* find_model_entry(const std::string& name);

/// Whether the model of that name reads the unfiltered environment, so that filter settings have no effect.
bool reads_radiance(const std::string& model);

/// The name of a model that lights an environment without its suns, which are traced: "lobe+suns".
std::string with_suns(const std::string& model);

/// A model, chosen for one visibility map.
struct ShadingModel
{
    std::string name;
    ModelLight light = ModelLight::cfem;
    /// Channels of the map, in the order that the model reads them. V and B come first, but for `ao`: V and the normal.
    std::vector<std::string> channels;
    const ModelEntry* entry = nullptr;
};

/// Find the model that `params` asks for; for `auto` the best that `vismap` has channels for, or, unless `has_stack` (a
/// stack is at hand, or an environment to filter into one), the best that needs only a CFEM.
///
/// @returns false, with the reason in `error`, if `vismap` is not a visibility map, is of strands and the model is not,
///          or lacks a channel that the model reads.
bool choose_model(ShadingModel& dst, const LightmapParams& params, const OIIO::ImageSpec& vismap, bool has_stack,
                  std::string& error);

/// Why `light`, of which the model of a map reads ModelEntry::light, is not what the map needs, or "": it was filtered
/// by another kernel.
std::string kernel_fault(const ShadingModel& model, const OIIO::ImageSpec& vismap, const OIIO::ImageSpec& light);

} // namespace vmlight
