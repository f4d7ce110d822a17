// SPDX-License-Identifier: Apache-2.0
#include "lights.h"

#include "least_seconds.h"

#include <vmlight/cfem/radiance.h>
#include <vmlight/cfem/stack.h>

#include <OpenImageIO/strutil.h>

namespace vmlight::cost {

const FilteredLight* Lights::find(size_t index, Light light, int width, const Progress& progress, std::string& error)
{
    FilteredLight& dst = m_made[{ index, light, width }];
    if (!dst.images.empty())
        return &dst;
    const Environment& environment = m_inputs.environments[index];
    CfemParams params;
    params.resolution = { width, width / 2 };
    params.sanitize = m_params.sanitize;
    const auto make = [&] {
        if (light == Light::Stack)
            return make_cfem_stack(dst.images, environment.image, params, error, m_options.threads, progress);
        dst.images.resize(1);
        if (light == Light::Radiance)
            return make_radiance(dst.images[0], environment.image, params, error, progress);
        const bool made = make_cfem(dst.images[0], environment.image, params, m_options.threads, progress);
        if (!made)
            error = dst.images[0].geterror();
        return made;
    };
    if (least_seconds(dst.seconds, make))
        return &dst;
    dst.images.clear();
    if (error != "interrupted")
        error = OIIO::Strutil::fmt::format("\"{}\": {}", environment.path, error);
    return nullptr;
}

} // namespace vmlight::cost
