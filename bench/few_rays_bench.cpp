// SPDX-License-Identifier: Apache-2.0
/// How much further from traced light a map of few rays is than one of many, as a Markdown table:
///
///     few_rays_bench FOLDER SIDE FEW MANY PAIRS MESH... -- SKY...
///
/// For the models `paper`, `lobe` and `sh` of five bands: the RMS error of the light at FEW and at MANY rays per texel,
/// relative to the mean light, the mean over the skies; and the ratio. Maps have SIDE texels a side; the reference has
/// PAIRS pairs of rays per texel, whose noise is subtracted. FOLDER, which must exist, has a folder for each mesh and
/// size: an interrupted run resumes there.
#include <vmcost/measure.h>
#include <vmcost/models.h>

#include <vmlight/base/format.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

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

void measure_mesh(const std::string& mesh, const std::vector<std::string>& skies, const CostParams& params, int few,
                  int many, const std::string& folder)
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
    const std::string name = OIIO::Filesystem::filename(mesh);
    const std::string own = format("{}/{}.{}", folder, name.substr(0, name.find('.')), params.side());
    std::string error;
    if (!OIIO::Filesystem::is_directory(own) && !OIIO::Filesystem::create_directory(own, error))
        fail(own + ": " + error);
    if (!read_inputs(inputs, recipe, skies, {}, options, error)
        || !trace_references(inputs, params, own, options, progress, error)
        || !measure(measured, settings, inputs, params, own, options, progress, error))
        fail(error);
    for (const char* model : kModels) {
        const double at_few = mean_error(measured.rows, model, few), at_many = mean_error(measured.rows, model, many);
        std::printf("| %s | `%s` | %.4f | %.4f | %.3f |\n", name.substr(0, name.find('.')).c_str(), model, at_few,
                    at_many, at_few / at_many);
    }
    std::fflush(stdout);
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
    for (auto mesh = words.begin() + 5; mesh != split; ++mesh)
        measure_mesh(*mesh, { split + 1, words.end() }, params, few, many, words[0]);
    return 0;
}
