// SPDX-License-Identifier: Apache-2.0
#include "measure.h"

#include "bench.h"
#include "heat_map_file.h"

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>

#include <algorithm>

namespace vmlight::cost {
namespace {

// Roughly proportional to the time.
double weight(const Setting& setting, size_t environments)
{
    const bool traced = setting.model == kTraced;
    const double rays = double(setting.samples) / (setting.divisor * setting.divisor);
    return 100 + (traced ? 2 * double(environments) : 1) * rays;
}

bool needs_heat_map(const Setting& setting)
{
    return setting == default_setting(setting.model);
}

} // namespace

bool measure(Measured& dst, const std::vector<Setting>& settings, const Inputs& inputs, const CostParams& params,
             const std::string& folder, const MakeOptions& options, std::string& error)
{
    Journal journal;
    const std::string name_of_journal = folder + "/journal.jsonl";
    if (!journal.open(name_of_journal, error))
        return false;
    if (journal.damaged() > 0)
        options.report_warning(format("\"{}\": {} damaged or of another version: measured again", name_of_journal,
                                      count_text(journal.damaged(), "row is", "rows are")));
    Bench bench(inputs, params, options);
    double total = 0, done = 0, part = 0;
    for (const Setting& setting : settings)
        total += weight(setting, inputs.environments.size());
    const int64_t texels = int64_t(settings.size()) * params.side() * params.side();
    const Progress progress = options.progress("measure", texels);
    double furthest = 0; // repeated work does not move the bar back
    const auto inner = [&](double share) {
        furthest = std::max(furthest, (done + share * part) / total * 0.999);
        return !progress || progress(furthest);
    };
    for (const Setting& setting : settings) {
        const size_t count = inputs.environments.size();
        part = weight(setting, count) / double(count);
        for (size_t i = 0; i < count; ++i, done += part) {
            const std::string key = bench.key(setting, i);
            const std::string& name = inputs.environments[i].name;
            const Row* known = journal.find(key);
            if (known && (!needs_heat_map(setting) || has_heat_map(folder, name, setting.model, key))) {
                dst.rows.push_back(*known);
                dst.rows.back().environment = name; // the file may have been renamed since
                ++dst.reused;
                continue;
            }
            Row row;
            OIIO::ImageBuf picture;
            if (!bench.measure(row, picture, setting, i, inner, error)
                || (needs_heat_map(setting)
                    && !write_heat_map(folder, name, setting.model, key, picture, inputs.environments[i].reference,
                                       error))
                || !journal.add(key, row, error))
                return false;
            dst.rows.push_back(row);
            ++dst.measured;
        }
    }
    if (progress)
        progress(1);
    return true;
}

} // namespace vmlight::cost
