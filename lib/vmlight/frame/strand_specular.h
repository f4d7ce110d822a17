// SPDX-License-Identifier: Apache-2.0
/// The highlights of strands in pictures: the specular lobe of Kajiya and Kay, which depends on the eye, and so is in
/// no lightmap.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/cfem/cone_levels.h>
#include <vmlight/frame/scene_light.h>
#include <vmlight/math/rotation.h>

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <memory>
#include <string>

namespace vmlight {

struct SpecularParams
{
    double strand_specular = 0, strand_exponent = 40;

    template <class Visit> void visit(Visit&& field)
    {
        field("strand_specular", strand_specular, Range { 0, 100 },
              "Strength of strand highlights: what an open strand mirrors of a constant sky; 0 switches them off");
        field("strand_exponent", strand_exponent, Range { 1, ConeLevels::kLargestExponent },
              "Exponent of the cosine lobe of strand highlights: larger is narrower");
    }
};

/// Filter an environment for highlights: the whole of it, with its suns. False, with the reason in `error`, if only a
/// filtered map is known.
///
/// @param light    with its environment
bool filter_for_specular(std::shared_ptr<const ConeLevels>& dst, const SceneLight& light, const SpecularParams& params,
                         int nthreads, std::string& error);

/// Highlights at one rotation of the light.
struct StrandSpecular
{
    std::shared_ptr<const ConeLevels> levels;
    Rotation to_environment;
    double strength = 0;

    /// What an open strand sends back towards the eye, white whatever its colour.
    /// @param tangent      of unit length
    /// @param direction    from the eye, of any length
    Imath::C3f look(const Imath::V3d& tangent, const Imath::V3d& direction) const;
};

} // namespace vmlight
