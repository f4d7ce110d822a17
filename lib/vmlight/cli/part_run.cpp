// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/part_run.h>

#include <vmlight/base/format.h>
#include <vmlight/base/interrupt.h>
#include <vmlight/base/part_number.h>
#include <vmlight/base/text_format.h>
#include <vmlight/base/tile_size.h>
#include <vmlight/cli/mesh_part_names.h>
#include <vmlight/image/image_file.h>
#include <vmlight/stage/bake_report.h>
#include <vmlight/stage/large_map.h>
#include <vmlight/stage/map_parts.h>
#include <vmlight/uv/udim.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace vmlight {
namespace {

// The parts of a bake that can be resumed: a killed one loses less than one of them.
constexpr int kResumeParts = 32;
// In the names of files: parts that the user asks for, and those that are gone with the bake.
constexpr const char *kPartWord = "part", *kResumeWord = "resume";

int resume_parts(Size size)
{
    const auto tiles = [](int side) { return (side + kTileSize - 1) / kTileSize; };
    return std::min(kResumeParts, tiles(size.width) * tiles(size.height));
}

std::string same_output_fault(const std::string& output, const PartFiles& one, const PartFiles& other)
{
    for (const MeshPartPattern& pattern : mesh_part_patterns())
        if (const std::string& a = one.*pattern.of_parts, &b = other.*pattern.of_parts; a != b)
            return format("\"{}\": the parts are of {} \"{}\" and \"{}\", which need {} in the file name", output,
                          pattern.nouns, a, b, pattern.text);
    return format("\"{}\": the parts are of tiles {} and {}, which need <UDIM> in the file name", output, one.udim,
                  other.udim);
}

} // namespace

PartRun::PartRun(StageMain& stage, const VismapRecipe& recipe, const PoseList& poses)
    : m_stage(stage)
    , m_recipe(recipe)
    , m_poses(poses)
{
    stage.group("Parts:");
    stage.option(
        "part", "K/N",
        "Bake part K of N of the map, such as 3/16 or 1-4,7/16, to files beside -o such as NAME.part03of16.exr",
        [&](auto text, auto& error) {
            if (parse_parts(m_parts, m_count, std::string(text), error))
                return true;
            error = "part: " + error;
            return false;
        });
    stage.option("resume", "",
                 "Keep finished parts beside -o until the map is whole, and do not bake again those that are there",
                 [&](auto, auto&) { return m_resumes = true; });
    stage.form("join", "PART.exr", "Join the parts of a map: byte for byte the file of one bake",
               "the parts are baked already: --join takes -o, --format, --compression, --threads and --quiet");
    stage.check([&] { return fault(); });
}

// What is wrong with the command line, or "".
std::string PartRun::fault() const
{
    if (!is_given())
        return "";
    const std::string flag = m_count > 0 ? "--part" : "--resume";
    if (m_recipe.time_budget > 0)
        return flag
            + ": a --time-budget depends on the machine, and all parts need as many rays: give --samples or "
              "--target-error";
    if (m_poses.is_sequence() || !m_poses.compared(m_recipe).empty())
        return flag + " is for one pose: of several, each keeps texels of those before";
    if (m_stage.is_dry_run())
        return flag + ": --dry-run is about the whole map: leave one of them out";
    if (m_count > 0 && m_stage.pixel_format() == "half")
        return "--part: parts are float, since the margin is filled from them: give --format half to --join";
    return "";
}

std::string PartRun::unsavable() const
{
    return m_count > 0 ? "--part cannot be saved in a recipe" : m_resumes ? "--resume cannot be saved in a recipe" : "";
}

bool PartRun::make(const VismapRecipe& recipe, const std::string& output, const MakeOptions& options,
                   std::string& error)
{
    PartRequest request;
    request.count = m_count > 0 ? m_count : resume_parts(recipe.vismap_params.size());
    request.parts = m_parts;
    if (m_count == 0) {
        request.parts.resize(size_t(request.count));
        std::iota(request.parts.begin(), request.parts.end(), 1);
    }
    const auto path_of = [&](int part) {
        return part_path(output, m_count > 0 ? kPartWord : kResumeWord, { part, request.count });
    };
    std::vector<int> kept;
    if (m_resumes)
        request.is_made = [&](int part, const OIIO::ImageSpec& spec) {
            const bool is_whole = is_whole_part(path_of(part), spec);
            if (is_whole)
                kept.push_back(part);
            return is_whole;
        };
    request.write = [&](int part, const OIIO::ImageBuf& image, std::string& reason) {
        const bool is_written = write_image(
            image, path_of(part), {}, [](double) { return !interrupted(); }, reason);
        if (is_written && m_count > 0) // the name is not that of -o
            options.report(format("part: {} in \"{}\"", part_text({ part, m_count }), path_of(part)));
        return is_written;
    };
    if (!make_vismap_parts(recipe, request, options, error))
        return false;
    if (m_resumes)
        options.report(format("resume: {} of {} {} there already", kept.size(),
                              count_text(int64_t(request.parts.size()), "part", "parts"),
                              plural(int64_t(kept.size()), "was", "were")));
    if (m_count > 0)
        return true;
    std::vector<std::string> paths(request.parts.size());
    std::transform(request.parts.begin(), request.parts.end(), paths.begin(), path_of);
    if (!write_joined(paths, output, error))
        return false;
    m_kept.insert(m_kept.end(), paths.begin(), paths.end());
    return true;
}

void PartRun::remove_kept() const
{
    for (const std::string& path : m_kept)
        OIIO::Filesystem::remove(path);
}

bool PartRun::write_joined(const std::vector<std::string>& parts, const std::string& output, std::string& error) const
{
    JoinReport report;
    OIIO::ImageSpec joined;
    MapFile file(output, m_stage.file_params());
    MapRows rows = file.rows([](double) { return !interrupted(); });
    rows.begin = [&, begin = rows.begin](OIIO::ImageSpec& spec, std::string& reason) {
        joined = spec;
        return begin(spec, reason);
    };
    if (!join_files(rows, parts, report, error) || !file.commit(error))
        return false;
    m_stage.say(format("join: {} to {}x{} texels; margin {:.2f} s", count_text(int64_t(parts.size()), "part", "parts"),
                       joined.width, joined.height, report.margin_seconds));
    if (const std::string warning = dark_warning(report.dark, report.covered); !warning.empty())
        m_stage.warn(warning);
    return true;
}

bool PartRun::join(std::string& error) const
{
    std::vector<PartFiles> maps;
    if (!sort_parts(maps, m_stage.operands(), error))
        return false;
    std::map<std::string, const PartFiles*> outputs;
    for (const PartFiles& map : maps) {
        std::string output = udim_path(m_stage.output(), map.udim);
        const MeshPartPattern* const pattern = mesh_part_pattern(output);
        if (pattern)
            output = mesh_part_path(output, *pattern, map.*pattern->of_parts);
        const auto [other, is_new] = outputs.emplace(output, &map);
        if (!is_new)
            error = same_output_fault(output, *other->second, map);
        if (error.empty())
            error = output_fault(output);
        if (!error.empty())
            return false;
    }
    for (const auto& [output, map] : outputs)
        if (!write_joined(map->paths, output, error))
            return false;
    return true;
}

} // namespace vmlight
