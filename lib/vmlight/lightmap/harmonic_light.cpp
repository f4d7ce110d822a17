// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/harmonic_light.h>

#include <vmlight/cfem/rows.h>
#include <vmlight/cfem/sh.h>
#include <vmlight/math/harmonics.h>
#include <vmlight/math/latlong.h>

#include <cmath>

namespace vmlight {

bool prepare_harmonics(HarmonicLight& dst, const OIIO::ImageBuf& radiance, int order, const Rotation& to_environment,
                       std::string& error)
{
    EnvironmentRows rows(radiance, false);
    std::vector<double> projected;
    // On one thread: the caller may hold a lock, and a small map is projected in a millisecond.
    if (!rows.open()
        || !project_harmonics(projected, order, rows.grid(), [&](int row, float* rgb) { return rows.read(row, rgb); },
                              1, {})) {
        error = rows.error();
        return false;
    }
    const std::vector<double> turned = rotate_harmonics(projected, order, to_environment);
    const int count = order * order;
    dst.order = order;
    dst.coefficients.assign(size_t(4 * count), 0.0f);
    // Y_0 is a constant; Y_1 is this times x, y, -z.
    const double constant = std::sqrt(0.25 / latlong::pi), linear = std::sqrt(0.75 / latlong::pi);
    const double scale[4] = { constant, linear, linear, -linear };
    for (int k = 0; k < count; ++k)
        for (int c = 0; c < 3; ++c)
            dst.coefficients[size_t(4 * k + c)] = float(turned[size_t(3 * k + c)] * (k < 4 ? scale[k] : 1));
    return true;
}

} // namespace vmlight
