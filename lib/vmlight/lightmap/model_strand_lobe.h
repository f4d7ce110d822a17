// SPDX-License-Identifier: Apache-2.0
/// The model `lobe` for strands: what B leaves open is lit through a lobe, the rest by the light around the tangent.
///     N C_r(R B / |B|) + (V - N) S(R t),   N = min(V, 2 |B|), r = |B| / N,
/// where C_r is the environment filtered by the lobe whose mean direction has length r (lobe_lookup.h), from the
/// hemisphere (r = 1/2) up, and S by the strand kernel. An open strand (B = 0) has exactly V S; light a + b.w gives
/// a V + b.B, as the rays would.
#pragma once

#include <vmlight/lightmap/cfem_lookup.h>
#include <vmlight/lightmap/lobe_lookup.h>
#include <vmlight/lightmap/model_shader.h>

#include <memory>
#include <string>

namespace vmlight {

/// Floats of a texel: V, B, t.
constexpr int kStrandLobeFloats = 7;

struct StrandLobeLight
{
    LobeLookup lobes; ///< of a stack filtered for strands
    CfemLookup sine; ///< S
};

/// ModelShader::shade(), kStrandLobeFloats per texel.
bool shade_strand_lobe(const StrandLobeLight& light, const ShadeSetup& setup, const float* vismap, size_t texels,
                       float* rgb);

/// For a stack whose kernel is that of strands.
std::unique_ptr<ModelShader> prepare_strand_lobe(const ModelInput& input, std::string& error);

} // namespace vmlight
