// SPDX-License-Identifier: Apache-2.0
/// The ladder of shading models, from the cheapest up. A new model is one line of the table in models.cpp.
#pragma once

#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/span.h>

#include <string>

namespace vmlight::cost {

/// What an environment is made into before it lights.
enum class Light
{
    Cosine, ///< make_cfem()
    Stack, ///< make_cfem_stack()
    Radiance ///< make_radiance()
};

struct Model
{
    /// Of its curve.
    const char* name;
    /// As LightmapParams::model.
    const char* shading;
    /// Sets what a visibility map needs beyond the defaults.
    void (*needs)(VismapParams& map);
    Light light;
    /// That are read of a texel, as float and as half; half is 0 where it is not exact enough to be offered.
    int float_bytes, half_bytes;
    /// Of its curve.
    const char* color;
};

OIIO::cspan<Model> models();

/// The exact sibling of all models: rays to the light at each picture, and no map.
constexpr const char* kTraced = "traced";

/// The model of that name, or nullptr: kTraced is none.
const Model* find_model(const std::string& name);

/// Of the curve of a model, or of kTraced.
const char* color_of(const std::string& name);

} // namespace vmlight::cost
