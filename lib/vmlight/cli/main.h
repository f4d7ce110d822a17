// SPDX-License-Identifier: Apache-2.0
/// What every stage's executable shares: flags made from params, progress, messages, exit codes. A main declares what
/// it takes, then gives the work.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/base/progress.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/recipe/chain.h>
#include <vmlight/stage/recipe/check.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imagebuf.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Exit codes of all executables.
enum class Exit
{
    Done = 0,
    Failed = 1,
    Usage = 2
};

/// What -o names: an EXR, or a folder that is made if there is none.
enum class OutputKind
{
    Image,
    Folder
};

class StageMain
{
public:
    /// @param name     of the executable
    /// @param purpose  one sentence
    /// @param operands names of the positional arguments, all of which are needed; the last may end in "...": one or
    ///                 more
    /// @param example  one or more command lines
    StageMain(std::string name, std::string purpose, std::vector<std::string> operands, std::string example,
              OutputKind output = OutputKind::Image);
    ~StageMain();

    /// A flag for each parameter that has none yet: `--max-distance 2` for `max_distance`, with `prefix` before its
    /// name. `params` must outlive run().
    template <class Params> void params(const char* heading, Params& params, const std::string& prefix = "")
    {
        group(heading);
        Params defaults = params;
        defaults.visit([&](const char* field, auto& value, const auto& allowed, const char* help) {
            using Allowed = std::decay_t<decltype(allowed)>;
            const std::string name = field, text = value_text(value, allowed);
            if (has_option(prefix + name))
                return;
            if constexpr (std::is_same_v<Allowed, Paths>) {
                // What the flag's first coming takes the place of, the next ones add to.
                auto lines = std::make_shared<std::string>();
                option(prefix + name, allowed_text(allowed), std::string(help) + "; may come more than once",
                       [&params, name, lines](OIIO::string_view given, std::string& error) {
                           *lines += (lines->empty() ? "" : "\n") + std::string(given);
                           return set_param(params, name, *lines, error);
                       });
            } else {
                const bool is_flag = std::is_same_v<Allowed, Flag>;
                option(prefix + name, is_flag ? "" : allowed_text(allowed),
                       text.empty() || is_flag ? help : help + (" [" + text + "]"),
                       [&params, name](OIIO::string_view given, std::string& error) {
                           return set_param(params, name, given, error);
                       });
            }
        });
    }
    /// Take a recipe in place of the operands, and print one (--print-recipe). Flags for what of `recipe` has none yet.
    ///
    /// @param recipe   the stage; must outlive run(). Flags override what its file or the operands say; one that cannot
    ///                 change the picture is wrong usage
    /// @param fill     puts the operands, of which none is a recipe of this stage, into `recipe`
    /// @param unsaid   nullptr, or which of the given flags a recipe cannot hold; "" if none
    template <class Recipe>
    void recipe(const char* heading, Recipe& recipe, std::function<void(const std::vector<std::string>& operands)> fill,
                std::function<std::string()> unsaid = {})
    {
        params(heading, recipe);
        take_recipe(
            { Recipe::kStage, std::move(fill), std::move(unsaid),
              [&recipe](const std::string& name, std::string& error) { return read_recipe(recipe, name, error); },
              [&recipe] { return recipe_fault(recipe, {}); }, [&recipe] { return recipe_text(recipe); },
              [&recipe](const std::string& name) { return unused_reason(recipe, name); } });
    }
    /// Takes the flag's value ("true" for one without); false and `error` refuse it. A flag may come more than once.
    /// All are taken in their order, when the operands are in their places.
    using Take = std::function<bool(OIIO::string_view text, std::string& error)>;
    void group(const std::string& heading);
    void option(const std::string& name, const std::string& metavar, const std::string& help, Take take);
    /// An option whose text is kept as it is; `dst` must outlive run().
    void option(const std::string& name, const std::string& metavar, const std::string& help, std::string& dst);

    /// Have the whole command line looked at before the work. `fault` returns what is wrong with it, or "": the exit
    /// code is that of wrong usage. Not asked where only a recipe is printed.
    void check(std::function<std::string()> fault);

    /// Parse the command line, see that the output can be written, then call `work`, which returns false and sets
    /// `error` on failure. Catches exceptions.
    /// @returns the process's exit code.
    int run(int argc, const char** argv, const std::function<bool(std::string& error)>& work);

    // For check() and `work`.
    const std::string& output() const;
    /// Numbers in the file that is written: "float" or "half".
    const std::string& pixel_format() const;
    /// The positional arguments.
    const std::vector<std::string>& operands() const;
    /// Threads, progress and messages as the user asked for; and the recipe, if one was given.
    MakeOptions make_options();
    /// A progress line for one step of the work, which makes an image of so many texels, on stderr; stops the work when
    /// the user interrupts.
    Progress progress(const std::string& step, int64_t texels);
    /// One line on stdout, unless --quiet.
    void say(const std::string& line) const;
    /// One line on stderr: the result is right, but may surprise.
    void warn(const std::string& line) const;
    /// Write to output() (or `path`) in the format the user asked for, else as float.
    bool write(const OIIO::ImageBuf& image, std::string& error);
    bool write(const OIIO::ImageBuf& image, const std::string& path, std::string& error);
    /// The same for several images of one file.
    bool write(OIIO::cspan<OIIO::ImageBuf> images, const std::string& path, std::string& error);

private:
    struct State;
    struct RecipeDoor
    {
        std::string stage;
        std::function<void(const std::vector<std::string>&)> fill;
        std::function<std::string()> unsaid;
        std::function<bool(const std::string& name, std::string& error)> read;
        std::function<std::string()> fault, text;
        std::function<std::string(const std::string& name)> unused;
    };
    bool has_option(const std::string& name) const;
    void take_recipe(RecipeDoor door);
    std::unique_ptr<State> m_state;
};

} // namespace vmlight
