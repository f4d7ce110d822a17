// SPDX-License-Identifier: Apache-2.0
#include "models.h"

#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/basis.h>

#include <iterator>
#include <vector>

namespace vmlight::cost {
namespace {

constexpr int kOrders[] = { 4, 5, 6, 8 };

// Models that are also tried with traced suns.
constexpr const char* kWithSuns[] = { "lobe", "cells" };

// In the order of the ladder. They also differ in lightness, for colour-blind readers and for print.
constexpr const char* kColors[] = { "#999999", "#0072b2", "#d55e00", "#a6dba0", "#5aae61", "#1b7837",
                                    "#00441b", "#cc79a7", "#762a83", "#e69f00", "#56b4e9", "#f0e442" };

std::vector<ModelVariant> make_variants()
{
    std::vector<ModelVariant> variants;
    const auto add = [&](const ModelEntry& model, const std::string& name, int order, bool suns = false) {
        variants.push_back({ name, &model, order, suns, kColors[variants.size() % std::size(kColors)] });
    };
    for (const ModelEntry& model : model_entries()) {
        const bool has_bands = find_basis(model.basis).parameter == std::string("order");
        for (const int order : kOrders)
            if (has_bands)
                add(model, model.name + std::to_string(order), order);
        if (!has_bands)
            add(model, model.name, 0);
    }
    for (const char* name : kWithSuns)
        add(*find_model_entry(name), with_suns(name), 0, true);
    return variants;
}

} // namespace

void ModelVariant::set_bake(VismapParams& map) const
{
    if (*model->basis)
        map.basis = model->basis;
    if (*model->added_channel)
        map.channels = { model->added_channel };
    if (order)
        map.order = order;
}

int ModelVariant::float_bytes() const
{
    VismapParams map;
    set_bake(map);
    const size_t channels = model->channels(describe_vismap("", map)).size();
    return int(sizeof(float)) * (int(channels) - model->unread);
}

OIIO::cspan<ModelVariant> model_variants()
{
    static const std::vector<ModelVariant> variants = make_variants();
    return variants;
}

const ModelVariant* find_variant(const std::string& name)
{
    for (const ModelVariant& variant : model_variants())
        if (name == variant.name)
            return &variant;
    return nullptr;
}

const char* color_of(const std::string& name)
{
    const ModelVariant* variant = find_variant(name);
    return variant ? variant->color : "#000000";
}

} // namespace vmlight::cost
