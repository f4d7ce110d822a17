// SPDX-License-Identifier: Apache-2.0
/// What a command line asks for: operands or a recipe, then flags, checked as a whole before any work starts.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/cli/command_line.h>
#include <vmlight/cli/exit_code.h>
#include <vmlight/image/image_file.h>

#include <functional>
#include <string>
#include <vector>

namespace vmlight {

/// What -o names: an EXR, a folder, which is created if necessary, or a picture or film of any kind that the executable
/// knows, whose name it checks itself. One that is optional need not be written.
enum class OutputKind
{
    Image,
    Folder,
    OptionalFolder,
    Picture,
    OptionalPicture
};

/// Parameters of every executable.
struct RunParams
{
    int threads = 0;
    bool quiet = false;

    template <class Visit> void visit(Visit&& field)
    {
        field("threads", threads, Range { 0, 1024 }, "Number of threads; 0: one per core");
        field("quiet", quiet, Flag {}, "Print only warnings and errors");
    }
};

/// The stage's recipe, whatever its type. The defaults are those of an executable without recipes.
struct RecipeAccess
{
    /// Store the operands, none of which is a recipe of the stage.
    std::function<void(const std::vector<std::string>&)> set_operands = [](const auto&) {};
    /// Which of the given flags cannot be saved in a recipe, or "".
    std::function<std::string()> unsavable = [] { return std::string(); };
    std::function<bool(const std::string& name, std::string& error)> read;
    /// What is wrong with the recipe as a whole, or "".
    std::function<std::string()> fault = [] { return std::string(); };
    /// The recipe as TOML, as the file `path` ("": none) must have it.
    std::function<std::string(const std::string& path)> text;
    /// Why the parameter has no effect with the others as they are, or "".
    std::function<std::string(const std::string& name)> unused_reason = [](const auto&) { return std::string(); };
};

struct StageCommand
{
    CommandLine line;
    RecipeAccess recipe;
    OutputKind output_kind = OutputKind::Image;
    /// Further checks, which return what is wrong, or "". Skipped if only a recipe is printed or saved.
    std::vector<std::function<std::string()>> checks;

    std::string output;
    /// --print-recipe; see saves_recipe().
    bool prints_recipe = false;
    /// --dry-run: nothing is written, and -o may be left out.
    bool is_dry_run = false;
    /// Set by a flag that asks for something else than an image: makes the text to print. See StageMain::answer().
    std::function<bool(std::string& text, std::string& error)> print;
    FileParams file;
    RunParams common;

    /// Parse the command line: the operands or the recipe first, then the flags, which override it.
    ///
    /// @param answer   set to the text to print instead of working, help and the like, or to the recipe to
    ///                 print or save
    /// @returns Done, or the exit code with the reason in `error`
    ExitCode parse(int argc, const char** argv, std::string& answer, std::string& error);

    /// Whether there is a flag of this name.
    bool has(const std::string& option) const;
    /// Whether it is on the command line.
    bool is_given(const std::string& option) const;

    /// Whether an image is to be made.
    bool makes_image() const { return !prints_recipe && !saves_recipe() && !print; }

    /// Whether -o names a recipe of this stage: the command line is saved as that, and no image is made.
    bool saves_recipe() const;

    /// Why the output cannot be written now, or "".
    std::string output_fault() const;

    /// What in the name of the output looks like a placeholder, such as "<NODE>", but stays as it is; or "".
    std::string output_warning() const;

private:
    bool needs_output() const;
    ExitCode apply(std::string& fault_of_recipe, std::string& error);
    std::string usage_fault(const std::string& fault_of_recipe) const;
    std::string image_name_fault() const;
    std::string unsavable() const;
};

} // namespace vmlight
