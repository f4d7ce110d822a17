// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/shade_kernel.h>
#include <vmlight/math/four_floats.h>

#include <cmath>

namespace vmlight {

bool shade_harmonics(const ShadeSetup& setup, VismapOrder, const float* vismap, size_t texels, float* rgb)
{
    const int count = setup.harmonics->order * setup.harmonics->order;
    const float* light = setup.harmonics->coefficients.data();
    bool sound = true;
    for (size_t i = 0; i < texels; ++i, vismap += count, rgb += 3) {
        // Two sums, so that each waits for the one before the last.
        FourFloats even {}, odd {};
        int k = 0;
        for (; k + 1 < count; k += 2) {
            even += all_four(vismap[k]) * load_four(light + 4 * k);
            odd += all_four(vismap[k + 1]) * load_four(light + 4 * (k + 1));
        }
        if (k < count)
            even += all_four(vismap[k]) * load_four(light + 4 * k);
        sound &= std::abs(vismap[0]) <= kLargestVisibility;
        const FourFloats sum = all_four(setup.gain) * (even + odd);
        for (int c = 0; c < 3; ++c) {
            sound &= std::isfinite(sum[c]);
            // What sees nothing has no light, whatever rounding left of its harmonics; and what is no number stays
            // none, to be found.
            rgb[c] = !(vismap[0] > 0) || (sum[c] < 0 && std::isfinite(sum[c])) ? 0.0f : sum[c];
        }
    }
    return sound;
}

} // namespace vmlight
