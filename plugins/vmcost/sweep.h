// SPDX-License-Identifier: Apache-2.0
/// The settings to measure.
#pragma once

#include <vmlight/vismap/vismap.h>

#include <cstddef>
#include <string>
#include <vector>

namespace vmlight::cost {

struct Setting
{
    /// One of model_variants(), or kTraced.
    std::string model;
    /// Rays per texel.
    int samples = VismapParams().samples;
    /// Width of the filtered environment in pixels; 0 if there is none.
    int cfem_width = 128;
    /// Pixel format of the visibility map: float or half; "" if there is none.
    std::string storage = "float";
    /// The reference's resolution divided by that of the visibility map, per side.
    int divisor = 1;

    template <class Visit> void visit(Visit&& field)
    {
        field("model", model);
        field("samples", samples);
        field("cfem_width", cfem_width);
        field("storage", storage);
        field("divisor", divisor);
    }
};

bool operator==(const Setting& a, const Setting& b);

/// The default setting of a model or of kTraced.
Setting default_setting(const std::string& model);

/// Whether only the number of samples differs from the default.
bool varies_samples_alone(const Setting& setting);

/// Roughly proportional to the time that a setting takes under so many environments; and a reference of so many pairs
/// of rays under one, on the same scale.
double weight_of(const Setting& setting, size_t environments);
double reference_weight(int pairs);

/// All models at all sample counts, and each of the other axes around the default where the model supports it. Settings
/// are unique; those that share a visibility map are adjacent.
std::vector<Setting> sweep(bool quick);

} // namespace vmlight::cost
