// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/stage_command.h>

#include <vmlight/base/format.h>
#include <vmlight/base/output_file.h>
#include <vmlight/base/utf8.h>
#include <vmlight/cli/mesh_part_names.h>
#include <vmlight/image/image_file.h>
#include <vmlight/stage/recipe/paths.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/uv/udim.h>

#include <algorithm>

namespace vmlight {

std::string StageCommand::output_fault() const
{
    if (output.empty() && !needs_output())
        return "";
    if (output_kind == OutputKind::Picture || output_kind == OutputKind::OptionalPicture)
        return output_file_fault(output);
    const bool is_folder = output_kind == OutputKind::Folder || output_kind == OutputKind::OptionalFolder;
    return is_folder ? output_folder_fault(output) : vmlight::output_fault(output);
}

bool StageCommand::has(const std::string& option) const
{
    return std::any_of(line.options.begin(), line.options.end(), [&](const auto& one) { return one.name == option; });
}

bool StageCommand::is_given(const std::string& option) const
{
    return std::any_of(line.given.begin(), line.given.end(),
                       [&](const auto& one) { return one.first->name == option; });
}

// A warning, as any name may be meant.
std::string StageCommand::output_warning() const
{
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
    for (size_t begin = output.find('<'); begin != std::string::npos; begin = output.find('<', begin + 1)) {
        const size_t end = output.find_first_not_of(letters, begin + 1);
        if (end == std::string::npos || output[end] != '>' || end < begin + 2)
            continue;
        const std::string text = output.substr(begin, end + 1 - begin);
        if (!has("udims"))
            return format("\"{}\": {} stays in the file name: {} replaces nothing in it", output, text, line.name);
        if (!has_udim_pattern(text) && !mesh_part_pattern(text))
            return format("\"{}\": {} stays in the file name: the placeholders are {}", output, text,
                          line.stage == VismapRecipe::kStage ? "<UDIM>, " + mesh_part_pattern_list() : "<UDIM>");
    }
    const bool has_numbers = is_given("frames") || is_given("pose");
    return output.find("##") != std::string::npos && has("frames") && !has_numbers
        ? format("\"{}\": # stays in the file name: pass --frames, such as 1-48, to number the files", output)
        : "";
}

bool StageCommand::needs_output() const
{
    return !is_dry_run && output_kind != OutputKind::OptionalPicture && output_kind != OutputKind::OptionalFolder;
}

bool StageCommand::saves_recipe() const
{
    return !print && !line.stage.empty() && stage_of_extension(output) == line.stage;
}

std::string StageCommand::image_name_fault() const
{
    const std::string fault = output_name_fault(output);
    return fault.empty() || line.stage.empty() || !is_recipe_name(output)
        ? fault
        : format("\"{}\": output must be .exr, or .{} for a recipe", output, line.stage);
}

// What cannot be saved in a recipe.
std::string StageCommand::unsavable() const
{
    std::vector<std::string> texts = line.operands;
    for (const auto& [option, text] : line.given)
        texts.push_back(text);
    for (const std::string& text : texts)
        if (!is_utf8(text))
            return format("\"{}\": not valid UTF-8, which recipes require", text);
    if (saves_recipe() && has_udim_pattern(output))
        return format("\"{}\": use <UDIM> in the paths of the recipe instead of its name: one recipe makes all tiles",
                      output);
    if (const MeshPartPattern* pattern = mesh_part_pattern(output); saves_recipe() && pattern)
        return format("\"{}\": {} is for the maps, not for the recipe that makes them", output, pattern->text);
    return recipe.unsavable();
}

ExitCode StageCommand::apply(std::string& fault_of_recipe, std::string& error)
{
    if (line.given_recipe() && has_udim_pattern(recipe_path(line.operands[0]))) {
        error = format("\"{}\": use <UDIM> in the paths of the recipe instead of its name: one recipe makes all tiles",
                       line.operands[0]);
        return ExitCode::Usage;
    }
    if (line.given_recipe()) {
        if (!recipe.read(line.operands[0], error))
            return ExitCode::Failed;
        fault_of_recipe = recipe.fault();
    } else if (!line.given_form()) {
        recipe.set_operands(line.operands);
    }
    for (const auto& [option, text] : line.given)
        if (!option->take(text, error)) {
            // The library names the parameter, which may be another: --ground sets ground_height.
            const std::string parameter = error.substr(0, error.find(": "));
            if (parameter == option->parameter || has(parameter))
                error.replace(0, parameter.size(), option->flag());
            return ExitCode::Usage;
        }
    return ExitCode::Done;
}

// Faults of the recipe's file are left to the work, which reports them with their line.
std::string StageCommand::usage_fault(const std::string& fault_of_recipe) const
{
    std::string fault;
    if (line.given_form())
        fault = line.form_fault();
    if (line.given_form() && fault.empty())
        fault = output.empty() ? line.missing_output() : output_name_fault(output);
    if (line.given_form())
        return fault;
    const bool works = makes_image();
    if (prints_recipe || saves_recipe())
        fault = unsavable();
    else if (works && output.empty() && needs_output())
        fault = line.missing_output();
    else if (works && !output.empty() && output_kind == OutputKind::Image)
        fault = image_name_fault();
    if (fault.empty() && (saves_recipe() || recipe.fault() != fault_of_recipe))
        fault = recipe.fault();
    for (const auto& [option, text] : line.given)
        if (const std::string reason = recipe.unused_reason(option->name); fault.empty() && !reason.empty())
            fault = format("{}{}: {}", option->flag(), option->metavar.empty() ? "" : " " + text, reason);
    for (const auto& check : checks)
        if (fault.empty() && works)
            fault = check();
    return fault;
}

ExitCode StageCommand::parse(int argc, const char** argv, std::string& answer, std::string& error)
{
    if (!line.parse(argc, argv, answer, error))
        return ExitCode::Usage;
    if (!answer.empty())
        return ExitCode::Done;
    std::string fault_of_recipe;
    const ExitCode applied = apply(fault_of_recipe, error);
    if (applied != ExitCode::Done)
        return applied;
    error = usage_fault(fault_of_recipe);
    if (error.empty() && (prints_recipe || saves_recipe()))
        answer = recipe.text(saves_recipe() ? output : "");
    if (!is_utf8(answer)) // folders between the recipe and its inputs
        error = format("\"{}\": a path in it is not valid UTF-8, which recipes require", output);
    return error.empty() ? ExitCode::Done : ExitCode::Usage;
}

} // namespace vmlight
