// SPDX-License-Identifier: Apache-2.0
#include "lights.h"

#include "timing.h"

#include <vmlight/base/format.h>
#include <vmlight/lightmap/model_light.h>

namespace vmlight::cost {

const FilteredLight* FilteredLights::find(size_t index, ModelLight light, int width, bool suns,
                                          const Progress& progress, std::string& error)
{
    FilteredLight& dst = m_made[{ index, light, width, suns }];
    if (!dst.images.empty())
        return &dst;
    const Environment& environment = m_inputs.environments[index];
    CfemParams params;
    params.resolution = { width, width / 2 };
    params.sanitize = m_params.sanitize;
    const auto make = [&] {
        SunSplit split;
        if (suns && !split.find(environment.image, params.sanitize, error, progress))
            return false;
        dst.suns = split.suns();
        return make_model_light(dst.images, split.rest(environment.image), params, light, error, m_options.threads,
                                progress);
    };
    Timing timing;
    if (measure_time(timing, make)) {
        dst.seconds = timing.seconds;
        return &dst;
    }
    dst.images.clear();
    if (error != "interrupted")
        error = format("\"{}\": {}", environment.path, error);
    return nullptr;
}

} // namespace vmlight::cost
