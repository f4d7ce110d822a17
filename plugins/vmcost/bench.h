// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lights.h"
#include "row.h"
#include "timing.h"

#include <vmlight/vismap/sun_visibility.h>

namespace vmlight::cost {

/// Measures one setting under one environment at a time. Caches the last visibility map and all filtered environments
/// for settings that share them. Not thread-safe.
class Bench
{
public:
    Bench(const Inputs& inputs, const CostParams& params, const MakeOptions& options);

    /// The key of a row: a hash of everything that it depends on.
    std::string key(const Setting& setting, size_t environment) const;

    /// @param picture  set to the lightmap, at the reference's size
    /// @returns false, with the reason in `error`, if a stage fails or `progress` stopped the work
    bool measure(Row& row, OIIO::ImageBuf& picture, const Setting& setting, size_t environment,
                 const Progress& progress, std::string& error);

private:
    // Before the first measurement: the weights of the errors.
    bool bake_visibility(const Progress& progress, std::string& error);
    bool bake(const Setting& setting, const Progress& progress, std::string& error);
    bool shade(Row& row, OIIO::ImageBuf& picture, const Setting& setting, size_t environment, const Progress& progress,
               std::string& error);
    bool trace(Row& row, OIIO::ImageBuf& picture, const Setting& setting, const Environment& environment,
               const Progress& progress, std::string& error);

    const Inputs& m_inputs;
    const CostParams& m_params;
    const MakeOptions& m_options;
    FilteredLights m_lights;
    OIIO::ImageBuf m_visibility; // of the reference's texels, one channel
    std::string m_baked; // parameters of m_vismap
    OIIO::ImageBuf m_vismap;
    Timing m_bake;
    int m_sun_side = 0; // of the maps that m_suns is ready for
    SunTracer m_suns;
};

} // namespace vmlight::cost
