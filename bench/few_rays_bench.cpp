// SPDX-License-Identifier: Apache-2.0
/// How much further from traced light a map of few rays is than one of many, as a Markdown table:
///
///     few_rays_bench FOLDER SIDE FEW MANY PAIRS MESH... -- SKY...
///
/// For the models `paper`, `lobe` and `sh` of five bands: the RMS error of the light at FEW and at MANY rays per texel,
/// relative to the mean light, the mean over the skies; the ratio; and the means over the meshes. Maps have SIDE texels
/// a side; the reference has PAIRS pairs of rays per texel, whose noise is subtracted. FOLDER, which must exist, has a
/// folder for each mesh and size: an interrupted run resumes there.
#include <vmcost/measure.h>
#include <vmcost/models.h>

#include <vmlight/base/format.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <iterator>

using namespace vmlight;
using namespace vmlight::cost;

namespace {

constexpr const char* kModels[] = { "paper", "lobe", "sh5" };

[[noreturn]] void fail(const std::string& error)
{
    std::fprintf(stderr, "few_rays_bench: %s\n", error.c_str());
    std::exit(1);
}

double mean_error(const std::vector<Row>& rows, const std::string& model, int samples)
{
    double sum = 0, count = 0;
    for (const Row& row : rows)
        if (row.setting.model == model && row.setting.samples == samples)
            sum += row.errors.rmse.value, ++count;
    return sum / count;
}

struct Pair
{
    double few = 0, many = 0;
};
using ByModel = std::array<Pair, std::size(kModels)>;

void print_rows(const std::string& name, const ByModel& errors)
{
    for (size_t i = 0; i < errors.size(); ++i)
        std::printf("| %s | `%s` | %.4f | %.4f | %.3f |\n", name.c_str(), kModels[i], errors[i].few, errors[i].many,
                    errors[i].few / errors[i].many);
    std::fflush(stdout);
}

ByModel measure_mesh(const std::string& mesh, const std::string& name, const std::vector<std::string>& skies,
                     const CostParams& params, int few, int many, const std::string& folder)
{
    VismapRecipe recipe;
    recipe.mesh = mesh;
    Inputs inputs;
    Measured measured;
    MakeOptions options;
    options.progress = [](const std::string&, int64_t) { return [](double) { return true; }; };
    options.say = [](const std::string&) {};
    options.warn = [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
    WholeProgress progress({}, 1);
    std::vector<Setting> settings;
    for (const char* model : kModels)
        for (const int samples : { few, many }) {
            settings.push_back(default_setting(model));
            settings.back().samples = samples;
        }
    std::stable_sort(settings.begin(), settings.end(),
                     [](const Setting& a, const Setting& b) { return a.samples < b.samples; });
    const std::string own = format("{}/{}.{}", folder, name, params.side());
    std::string error;
    if (!OIIO::Filesystem::is_directory(own) && !OIIO::Filesystem::create_directory(own, error))
        fail(own + ": " + error);
    if (!read_inputs(inputs, recipe, skies, {}, options, error)
        || !trace_references(inputs, params, own, options, progress, error)
        || !measure(measured, settings, inputs, params, own, options, progress, error))
        fail(error);
    ByModel errors;
    for (size_t i = 0; i < errors.size(); ++i)
        errors[i] = { mean_error(measured.rows, kModels[i], few), mean_error(measured.rows, kModels[i], many) };
    return errors;
}

} // namespace

int main(int argc, char** argv)
{
    const std::vector<std::string> words(argv + 1, argv + argc);
    const auto split = std::find(words.begin(), words.end(), "--");
    if (split - words.begin() < 6 || words.end() - split < 2)
        fail("usage: few_rays_bench FOLDER SIDE FEW MANY PAIRS MESH... -- SKY...");
    CostParams params;
    params.resolution = OIIO::Strutil::stoi(words[1]);
    params.reference_samples = OIIO::Strutil::stoi(words[4]);
    const int few = OIIO::Strutil::stoi(words[2]), many = OIIO::Strutil::stoi(words[3]);
    std::printf("| mesh | model | error, %d rays | %d rays | ratio |\n|---|---|---|---|---|\n", few, many);
    ByModel means;
    const auto first = words.begin() + 5;
    for (auto mesh = first; mesh != split; ++mesh) {
        const std::string file = OIIO::Filesystem::filename(*mesh), name = file.substr(0, file.find('.'));
        const ByModel errors = measure_mesh(*mesh, name, { split + 1, words.end() }, params, few, many, words[0]);
        print_rows(name, errors);
        for (size_t i = 0; i < means.size(); ++i) {
            means[i].few += errors[i].few / double(split - first);
            means[i].many += errors[i].many / double(split - first);
        }
    }
    print_rows("**all**", means);
    return 0;
}
