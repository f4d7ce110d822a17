// SPDX-License-Identifier: Apache-2.0
#include "sweep.h"

#include "models.h"

#include <algorithm>

namespace vmlight::cost {
namespace {

struct Axes
{
    std::vector<int> samples, widths, divisors, traced;
};

Axes axes(bool quick)
{
    if (quick)
        return { { 16, 64, 128, 256 }, { 32, 128 }, { 1, 2 }, { 16, 64, 128, 256 } };
    // Longer tracing adds nothing to the known slope.
    return {
        { 16, 32, 64, 128, 256, 512, 1024, 4096 }, { 32, 64, 128, 256, 512 }, { 1, 2, 4 }, { 16, 32, 64, 128, 256, 512 }
    };
}

void add(std::vector<Setting>& settings, const Setting& setting)
{
    if (std::find(settings.begin(), settings.end(), setting) == settings.end())
        settings.push_back(setting);
}

void add_model(std::vector<Setting>& settings, const ModelVariant& model, const Axes& axes)
{
    const Setting center = default_setting(model.name);
    const auto with = [&](auto Setting::*member, auto value) {
        Setting setting = center;
        setting.*member = value;
        add(settings, setting);
    };
    for (const int samples : axes.samples)
        with(&Setting::samples, samples);
    for (const int width : axes.widths)
        with(&Setting::cfem_width, width);
    if (model.half_bytes())
        with(&Setting::storage, "half");
    for (const int divisor : axes.divisors)
        with(&Setting::divisor, divisor);
}

} // namespace

bool operator==(const Setting& a, const Setting& b)
{
    return a.model == b.model && a.samples == b.samples && a.cfem_width == b.cfem_width && a.storage == b.storage
        && a.divisor == b.divisor;
}

Setting default_setting(const std::string& model)
{
    Setting setting;
    setting.model = model;
    if (model == kTraced) {
        setting.cfem_width = 0;
        setting.storage.clear();
    }
    return setting;
}

bool varies_samples_alone(const Setting& setting)
{
    Setting other = default_setting(setting.model);
    other.samples = setting.samples;
    return setting == other;
}

double weight_of(const Setting& setting, size_t environments)
{
    const bool traced = setting.model == kTraced;
    const double rays = double(setting.samples) / (setting.divisor * setting.divisor);
    return 100 + (traced ? 2 * double(environments) : 1) * rays;
}

double reference_weight(int pairs)
{
    return 2 * pairs;
}

std::vector<Setting> sweep(bool quick)
{
    const Axes values = axes(quick);
    std::vector<Setting> settings;
    for (const ModelVariant& model : model_variants())
        add_model(settings, model, values);
    for (const int samples : values.traced) {
        settings.push_back(default_setting(kTraced));
        settings.back().samples = samples;
    }
    // Few rays first, so that an interrupted run has measured many settings.
    std::stable_sort(settings.begin(), settings.end(), [](const Setting& a, const Setting& b) {
        return std::make_pair(a.samples, a.divisor) < std::make_pair(b.samples, b.divisor);
    });
    return settings;
}

} // namespace vmlight::cost
