// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/strand_specular.h>

#include <utility>

namespace vmlight {

bool filter_for_specular(std::shared_ptr<const ConeLevels>& dst, const SceneLight& light, const SpecularParams& params,
                         int nthreads, std::string& error)
{
    if (!light.environment.initialized()) {
        error = "--strand-specular needs the environment itself, and this is only its filtered map";
        return false;
    }
    auto levels = std::make_shared<ConeLevels>();
    if (!levels->make(light.environment, params.strand_exponent, nthreads, error))
        return false;
    dst = std::move(levels);
    return true;
}

Imath::C3f StrandSpecular::look(const Imath::V3d& tangent, const Imath::V3d& direction) const
{
    Imath::C3f rgb;
    levels->look(&rgb.x, rotate(to_environment, tangent), tangent.dot(direction) / direction.length());
    return rgb * float(strength);
}

} // namespace vmlight
