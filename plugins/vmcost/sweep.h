// SPDX-License-Identifier: Apache-2.0
/// Which settings are measured.
#pragma once

#include <string>
#include <vector>

namespace vmlight::cost {

struct Setting
{
    /// Of models(), or kTraced.
    std::string model;
    /// Rays a texel.
    int samples = 128;
    /// Of the filtered environment, in pixels; 0 where there is none.
    int cfem_width = 128;
    /// Of the visibility map: float or half; "" where there is none.
    std::string storage = "float";
    /// How many times smaller the visibility map is than the reference, each way.
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

/// What a model is measured with where nothing else is said; traced with as many rays.
Setting default_setting(const std::string& model);

/// Is nothing but the number of samples other than the default?
bool varies_samples_alone(const Setting& setting);

/// All models at all counts of samples; and each of the other axes around the default, for all models that know it.
/// No setting comes twice; those that share a visibility map stand together.
std::vector<Setting> sweep(bool quick);

} // namespace vmlight::cost
