// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/model_light.h>

#include <vmlight/base/oiio_compat.h>
#include <vmlight/cfem/radiance.h>
#include <vmlight/cfem/stack.h>

namespace vmlight {

bool make_model_light(std::vector<OIIO::ImageBuf>& dst, const Environment& env, const CfemParams& params,
                      ModelLight light, std::string& error, int nthreads, const Progress& progress)
{
    if (light == ModelLight::lobes)
        return make_cfem_stack(dst, env, params, error, nthreads, progress);
    dst.resize(1);
    if (light == ModelLight::radiance)
        return make_radiance(dst[0], env, params, error, progress);
    if (make_cfem(dst[0], env, params, nthreads, progress))
        return true;
    error = oiio::error_line(dst[0]);
    return false;
}

} // namespace vmlight
