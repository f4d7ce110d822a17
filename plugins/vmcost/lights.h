// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "inputs.h"
#include "models.h"

#include <vmlight/cfem/suns.h>

#include <map>
#include <tuple>

namespace vmlight::cost {

/// An environment, filtered for a model, and the time it took.
struct FilteredLight
{
    std::vector<OIIO::ImageBuf> images;
    std::vector<Sun> suns; ///< that were split off before
    double seconds = 0;
};

/// Cache of filtered environments. Not thread-safe.
class FilteredLights
{
public:
    FilteredLights(const Inputs& inputs, const CostParams& params, const MakeOptions& options)
        : m_inputs(inputs)
        , m_params(params)
        , m_options(options)
    {
    }

    /// @param suns     split the suns off before
    /// Returns nullptr, with the reason in `error`, if filtering fails or `progress` stopped it.
    const FilteredLight* find(size_t environment, ModelLight light, int width, bool suns, const Progress& progress,
                              std::string& error);

private:
    const Inputs& m_inputs;
    const CostParams& m_params;
    const MakeOptions& m_options;
    std::map<std::tuple<size_t, ModelLight, int, bool>, FilteredLight> m_made;
};

} // namespace vmlight::cost
