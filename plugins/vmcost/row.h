// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "statistics.h"
#include "sweep.h"

#include <string>

namespace vmlight::cost {

/// A measurement: one setting under one environment.
struct Row
{
    std::string environment;
    Setting setting;
    /// Seconds: bake, once; filtering, per environment; shading, per rotation.
    double bake = 0, light = 0, shade = 0;
    /// Timing::spread of shading.
    double spread = 0;
    /// Read per texel.
    int bytes = 0;
    Errors errors;

    /// Columns of the tables, in order.
    template <class Visit> void visit(Visit&& field)
    {
        field("environment", environment);
        setting.visit(field);
        field("bytes", bytes);
        field("bake_seconds", bake);
        field("light_seconds", light);
        field("shade_seconds", shade);
        field("shade_spread", spread);
        field("rmse", errors.rmse.value);
        field("rmse_low", errors.rmse.low);
        field("rmse_high", errors.rmse.high);
        field("rmse_by_visibility", errors.rmse_by_visibility);
        field("bias", errors.bias.value);
        field("bias_low", errors.bias.low);
        field("bias_high", errors.bias.high);
        field("p95", errors.p95);
    }
};

} // namespace vmlight::cost
