// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "inputs.h"
#include "models.h"

#include <map>
#include <tuple>

namespace vmlight::cost {

/// An environment as a model wants it, and the seconds that it took.
struct FilteredLight
{
    std::vector<OIIO::ImageBuf> images;
    double seconds = 0;
};

/// Filtered environments, each made once. One thread.
class Lights
{
public:
    Lights(const Inputs& inputs, const CostParams& params, const MakeOptions& options)
        : m_inputs(inputs)
        , m_params(params)
        , m_options(options)
    {
    }

    /// nullptr, with the reason in `error`, if it cannot be made or `progress` stopped the work.
    const FilteredLight* find(size_t environment, ModelLight light, int width, const Progress& progress,
                              std::string& error);

private:
    const Inputs& m_inputs;
    const CostParams& m_params;
    const MakeOptions& m_options;
    std::map<std::tuple<size_t, ModelLight, int>, FilteredLight> m_made;
};

} // namespace vmlight::cost
