// SPDX-License-Identifier: Apache-2.0
#include "models.h"

namespace vmlight::cost {
namespace {

void nothing(VismapParams&) { }

void normals(VismapParams& map)
{
    map.normal = true;
}

// Colours that also differ in lightness, for who sees few hues and for print.
constexpr Model kModels[] = {
    { "ao", normals, Light::Cosine, 16, 8, "#999999" },
    { "paper", nothing, Light::Cosine, 16, 8, "#0072b2" },
    { "lobe", nothing, Light::Stack, 16, 8, "#d55e00" },
};

} // namespace

OIIO::cspan<Model> models()
{
    return kModels;
}

const Model* find_model(const std::string& name)
{
    for (const Model& model : kModels)
        if (name == model.name)
            return &model;
    return nullptr;
}

const char* color_of(const std::string& name)
{
    const Model* model = find_model(name);
    return model ? model->color : "#000000";
}

} // namespace vmlight::cost
