// SPDX-License-Identifier: Apache-2.0
/// What each effect that the scene calls for costs, and how wrong the picture is without it.
#pragma once

#include "inputs.h"

#include <string>
#include <vector>

namespace vmlight::cost {

/// One effect: everything is made with it, and once more without it alone.
struct EffectCost
{
    std::string name, reason;
    /// Seconds with and without it: of the bake, or, for suns and the bounce, of the light of one rotation.
    double seconds = 0, without = 0;
    /// How far V is off without it, RMS over the covered texels; 0 for suns and the bounce.
    double visibility = 0;
    /// How far light by the model `lobe` is off, RMS over the covered texels, relative to its mean: the mean of all
    /// environments.
    double light = 0;

    /// Columns of the tables, in order.
    template <class Visit> void visit(Visit&& field)
    {
        field("effect", name);
        field("reason", reason);
        field("seconds", seconds);
        field("seconds_without", without);
        field("visibility_error_without", visibility);
        field("light_error_without", light);
    }
};

/// Roughly the time that this takes, on the scale of weight_of().
double effects_weight(size_t environments);

/// Measure those that can be left out and that the scene calls for, at the reference's size and the default number of
/// rays.
///
/// @param mesh     what was read as `inputs`
/// @returns false, with the reason in `error`, if a stage fails or `progress` stopped the work
bool measure_effects(std::vector<EffectCost>& dst, const Inputs& inputs, const VismapRecipe& mesh,
                     const CostParams& params, const MakeOptions& options, const Progress& progress,
                     std::string& error);

} // namespace vmlight::cost
