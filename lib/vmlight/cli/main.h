// SPDX-License-Identifier: Apache-2.0
/// The common part of every executable: flags made from params, recipes, progress, messages, exit codes. A main()
/// declares what it accepts, then passes its work to run().
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/base/progress.h>
#include <vmlight/cli/param_options.h>
#include <vmlight/cli/stage_command.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/recipe/chain.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/stage/recipe/unused_flags.h>

#include <OpenImageIO/imagebuf.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace vmlight {

class StageMain
{
public:
    /// @param name     of the executable
    /// @param purpose  what it does, in a phrase
    /// @param operands names of the positional arguments, all required; the last may end in "...": one or more
    /// @param example  one or more command lines
    StageMain(std::string name, std::string purpose, std::vector<std::string> operands, std::string example,
              OutputKind output = OutputKind::Image);

    /// Add a flag for each parameter that has none yet, with `prefix` before its name. `params` must outlive run().
    template <class Params> void params(const char* heading, Params& params, const std::string& prefix = "")
    {
        group(heading);
        for (CommandLine::Option& option : options_of(heading, params, prefix))
            if (!m_command.has(option.name))
                m_command.line.options.push_back(std::move(option));
    }

    /// Replace the help of a flag that means something else here than where its parameter is from.
    void reword(const std::string& name, const std::string& help);
    /// Take back the flag of a parameter that has no effect here.
    void drop(const std::string& name);

    /// Accept a recipe in place of the operands, and --print-recipe. Adds flags for those parameters of `recipe` that
    /// have none yet. Flags override the recipe; a flag that has no effect is refused as wrong usage.
    ///
    /// @param recipe       of the stage; must outlive run()
    /// @param set_operands stores the operands, none of which is a recipe of this stage, in `recipe`
    /// @param unsavable    which of the given flags cannot be saved in a recipe, or ""
    template <class Recipe>
    void recipe(const char* heading, Recipe& recipe,
                std::function<void(const std::vector<std::string>& operands)> set_operands,
                std::function<std::string()> unsavable)
    {
        params(heading, recipe);
        accept_recipe(
            Recipe::kStage,
            { std::move(set_operands), std::move(unsavable),
              [&recipe](const std::string& name, std::string& error) { return read_recipe(recipe, name, error); },
              [&recipe] { return recipe_fault(recipe, {}); },
              [&recipe](const std::string& path) { return recipe_text(recipe, path); },
              [&recipe](const std::string& name) { return unused_reason(recipe, name); } });
    }

    /// Receives a flag's value ("true" for one without). Returns false, with the reason in `error`, to refuse it.
    /// Called for each occurrence, in order, after the operands are stored.
    using Take = std::function<bool(OIIO::string_view text, std::string& error)>;
    /// Start a group of flags under a heading.
    void group(const std::string& heading);
    /// Add a flag; `metavar` is "" if it takes no value.
    void option(const std::string& name, const std::string& metavar, const Help& help, Take take);
    /// Add a flag that stores its text in `dst`, which must outlive run().
    void option(const std::string& name, const std::string& metavar, const Help& help, std::string& dst);
    /// Add a flag that prints a text instead of making an image. `print` returns false, with the reason in `error`, on
    /// failure.
    void answer(const std::string& name, const Help& help,
                std::function<bool(std::string& text, std::string& error)> print);
    /// Add a flag with which the operands are `operand`, one or more, and no recipe. Other flags than those of the
    /// output are refused then, for the `reason`, and no check() is made; see is_form().
    void form(const std::string& name, const std::string& operand, const Help& help, const std::string& reason);
    /// Add --dry-run, which reports what the work would do and take, and writes nothing: see is_dry_run().
    void dry_run(const Help& help);
    /// Add a check of the whole command line. `fault` returns what is wrong (exit code 2), or "". Skipped if only a
    /// recipe is printed or saved.
    void check(std::function<std::string()> fault);
    /// Refuse flags that cannot change the result, for tools without recipes: `reason` returns why, given the name of
    /// the parameter, or "".
    void unused(std::function<std::string(const std::string& name)> reason);

    /// The process goes on after run(): it can be interrupted then too, and compresses what it writes only if
    /// --compression says so, as that takes most of the time. Warnings are noted in `warned`, which must outlive run().
    /// Called while flags are taken.
    void stay_up(std::set<std::string>& warned);
    /// Another run of a process that stays up: what was said before is not said again.
    void repeat() { m_is_repeated = true; }

    /// Parse the command line, check that the output can be written, then call `work`, which returns false and sets
    /// `error` on failure. Catches exceptions.
    /// @returns the process's exit code.
    int run(int argc, const char** argv, const std::function<bool(std::string& error)>& work);

    // For check() and `work`.
    const std::string& name() const { return m_command.line.name; }
    const std::string& output() const { return m_command.output; }
    /// Whether --quiet is given.
    bool is_quiet() const { return m_command.common.quiet; }
    /// Whether say() prints nothing.
    bool is_silent() const { return is_quiet() || m_is_repeated; }
    /// Whether nothing is to be written; output() may then be "".
    bool is_dry_run() const { return m_command.is_dry_run; }
    /// Whether the flag of form() is given.
    bool is_form() const { return m_command.line.given_form(); }
    /// Pixel format of the output file: "float" or "half".
    const std::string& pixel_format() const { return m_command.file.format; }
    /// How the output is stored.
    const FileParams& file_params() const { return m_command.file; }
    /// The positional arguments.
    const std::vector<std::string>& operands() const { return m_command.line.operands; }
    /// Threads, progress, messages, and the recipe if one was given.
    MakeOptions make_options();
    /// A progress line on stderr for one step of the work, which makes an image of `texels`. Stops the work on Ctrl-C.
    Progress progress(const std::string& step, int64_t texels);
    /// Print a line on stdout, unless --quiet.
    void say(const std::string& line) const;
    /// Print a line on stdout that a flag asked for, even with --quiet.
    void answer(const std::string& line) const;
    /// Print a warning on stderr: the result is correct but may surprise.
    void warn(const std::string& line) const;
    /// Write an image to output() or `path` in the requested pixel format.
    bool write(const OIIO::ImageBuf& image, std::string& error);
    bool write(const OIIO::ImageBuf& image, const std::string& path, std::string& error);
    /// The same for several images (EXR parts) in one file.
    bool write(OIIO::cspan<OIIO::ImageBuf> images, const std::string& path, std::string& error);

private:
    void accept_recipe(const char* stage, RecipeAccess access);
    bool do_work(const std::function<bool(std::string& error)>& work, std::string& error);
    std::string with_flags(std::string error) const;
    void settle_threads();
    bool put(const std::string& answer, std::string& error) const;
    void report(const char* severity, const std::string& text) const;

    StageCommand m_command;
    std::set<std::string>* m_warned = nullptr; // set if the process stays up
    bool m_is_repeated = false;
    std::string m_heading;
};

} // namespace vmlight
