// SPDX-License-Identifier: Apache-2.0
/// The ladder of shading models, from the cheapest up: every row of the library's table, and of a basis that has bands
/// several variants.
#pragma once

#include <vmlight/lightmap/model.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/span.h>

#include <string>

namespace vmlight::cost {

/// One curve: a shading model, and the visibility map that it reads.
struct ModelVariant
{
    std::string name;
    const ModelEntry* model;
    /// VismapParams::order; 0 if the model's basis has no bands.
    int order;
    /// Whether suns are split off the light and traced (cfem/suns.h); the model lights the rest.
    bool suns;
    const char* color;

    /// Set what the visibility map needs beyond the defaults.
    void set_bake(VismapParams& map) const;
    /// Bytes of a texel that are read, stored as float.
    int float_bytes() const;
    /// The same stored as half; 0 if half cannot hold them.
    int half_bytes() const { return model->whole_numbers > 0 ? 0 : float_bytes() / 2; }
};

OIIO::cspan<ModelVariant> model_variants();

/// The unbiased alternative to all models: ray trace the light for each picture, without a map.
constexpr const char* kTraced = "traced";

/// The variant of that name, or nullptr: kTraced has none.
const ModelVariant* find_variant(const std::string& name);

/// Of the curve of a variant, or of kTraced.
const char* color_of(const std::string& name);

} // namespace vmlight::cost
