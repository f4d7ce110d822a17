// SPDX-License-Identifier: Apache-2.0
#include "lights.h"

#include "timing.h"

#include <vmlight/base/format.h>
#include <vmlight/lightmap/model_light.h>

namespace vmlight::cost {

const FilteredLight* FilteredLights::find(size_t index, ModelLight light, int width, const Progress& progress,
                                          std::string& error)
{
    FilteredLight& dst = m_made[{ index, light, width }];
    if (!dst.images.empty())
        return &dst;
    const Environment& environment = m_inputs.environments[index];
    CfemParams params;
    params.resolution = { width, width / 2 };
    params.sanitize = m_params.sanitize;
    const auto make = [&] {
        return make_model_light(dst.images, environment.image, params, light, error, m_options.threads, progress);
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
