// SPDX-License-Identifier: Apache-2.0
#include "measure.h"

#include "bench.h"
#include "heat_map_file.h"

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>

#include <algorithm>

namespace vmlight::cost {
namespace {

bool needs_heat_map(const Setting& setting)
{
    return setting == default_setting(setting.model);
}

} // namespace

bool measure(Measured& dst, const std::vector<Setting>& settings, const Inputs& inputs, const CostParams& params,
             const std::string& folder, const MakeOptions& options, WholeProgress& progress, std::string& error)
{
    Journal journal;
    const std::string name_of_journal = folder + "/journal.jsonl";
    if (!journal.open(name_of_journal, error))
        return false;
    if (journal.damaged() > 0)
        options.report_warning(format("\"{}\": {} damaged or of another version: measured again", name_of_journal,
                                      count_text(journal.damaged(), "row is", "rows are")));
    Bench bench(inputs, params, options);
    const size_t count = inputs.environments.size();
    const auto part = [&](const Setting& setting) { return weight_of(setting, count) / double(count); };
    const auto known_row = [&](const Setting& setting, size_t i, const std::string& key) -> const Row* {
        const bool has_map
            = !needs_heat_map(setting) || has_heat_map(folder, inputs.environments[i].name, setting.model, key);
        return has_map ? journal.find(key) : nullptr;
    };
    for (const Setting& setting : settings)
        for (size_t i = 0; i < count; ++i)
            if (known_row(setting, i, bench.key(setting, i)))
                progress.skip(part(setting));
    for (const Setting& setting : settings) {
        for (size_t i = 0; i < count; ++i) {
            const std::string key = bench.key(setting, i);
            const std::string& name = inputs.environments[i].name;
            if (const Row* known = known_row(setting, i, key)) {
                dst.rows.push_back(*known);
                dst.rows.back().environment = name; // the file may have been renamed since
                ++dst.reused;
                continue;
            }
            Row row;
            OIIO::ImageBuf picture;
            if (!bench.measure(row, picture, setting, i, progress.part(part(setting)), error)
                || (needs_heat_map(setting)
                    && !write_heat_map(folder, name, setting.model, key, picture, inputs.environments[i].reference,
                                       error))
                || !journal.add(key, row, error))
                return false;
            dst.rows.push_back(row);
            ++dst.measured;
        }
    }
    return true;
}

} // namespace vmlight::cost
