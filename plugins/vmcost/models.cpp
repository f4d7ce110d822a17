// SPDX-License-Identifier: Apache-2.0
#include "models.h"

namespace vmlight::cost {
namespace {

void nothing(VismapParams&) { }

void normals(VismapParams& map)
{
    map.channels = { "normal" };
}

template <int kOrder> void harmonics(VismapParams& map)
{
    map.basis = "sh";
    map.order = kOrder;
}

void mask(VismapParams& map)
{
    map.basis = "mask";
}

void cells(VismapParams& map)
{
    map.basis = "cells";
}

// Colours that also differ in lightness, for who sees few hues and for print.
constexpr Model kModels[] = {
    { "ao", "ao", normals, Light::Cosine, 16, 8, "#999999" },
    { "paper", "paper", nothing, Light::Cosine, 16, 8, "#0072b2" },
    { "lobe", "lobe", nothing, Light::Stack, 16, 8, "#d55e00" },
    { "sh4", "sh", harmonics<4>, Light::Radiance, 64, 32, "#a6dba0" },
    { "sh5", "sh", harmonics<5>, Light::Radiance, 100, 50, "#5aae61" },
    { "sh6", "sh", harmonics<6>, Light::Radiance, 144, 72, "#1b7837" },
    { "sh8", "sh", harmonics<8>, Light::Radiance, 256, 128, "#00441b" },
    // V, n and the packed numbers. (The map has B, too, for paper and lobe.)
    { "mask", "mask", mask, Light::Radiance, 60, 0, "#cc79a7" },
    { "cells", "cells", cells, Light::Radiance, 64, 0, "#762a83" },
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
