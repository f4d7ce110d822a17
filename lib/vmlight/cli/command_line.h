// SPDX-License-Identifier: Apache-2.0
/// The command line of an executable: the flags and operands that it accepts, and the parser.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/cli/allowed_value.h>

#include <OpenImageIO/string_view.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace vmlight {

/// The heading of the flags that every executable has for what it writes.
constexpr const char* kOutputHeading = "Output:";

/// "-o" for "o", "--max-distance" for "max_distance".
std::string flag_of(const std::string& name);

struct CommandLine
{
    struct Option
    {
        /// `metavar` is what stands for the value in the help; "" for a flag without a value; in brackets, a number
        /// that may be left out: the value is then "true".
        std::string heading, name, metavar, help;
        /// Receives the value ("true" for a flag without one). Returns false, with the reason in `error`, to refuse it.
        /// parse() does not call it.
        std::function<bool(OIIO::string_view text, std::string& error)> take {};
        bool is_advanced = false;
        /// Whether each occurrence adds a value; otherwise the last one wins.
        bool is_repeatable = false;
        /// The words that it accepts, if it is one that takes words.
        std::vector<Choice> choices {};
        /// The parameter that the value is for, as messages of the library name it, and what it allows.
        std::string parameter {};
        AllowedValue allowed {};

        std::string flag() const { return flag_of(name); }
        bool takes_file() const
        {
            return metavar == "FILE" || metavar == "FOLDER" || metavar == "OUTPUT.exr" || metavar == "PICTURE";
        }
    };
    struct Section
    {
        std::string heading;
        std::vector<const Option*> options;
    };

    /// For the help: the executable, what it does, example command lines with their remarks, and what -o names.
    std::string name, purpose, example, output_metavar;
    bool needs_output = true;
    /// The stage whose recipe may replace the operands, or "".
    std::string stage;
    /// Whether a name is that of such a recipe; if not set, its extension says so, and no name has a ?query.
    std::function<bool(const std::string& name)> is_recipe {};
    /// Another way to call it: with the flag `name` ("": there is none) the operands are `operand`, one or more, and of
    /// the other flags only those of the output are taken; the others would change nothing, for the `reason`.
    struct Form
    {
        std::string name, operand, reason;
    };
    Form form {};
    /// The last may end in "...": one or more. Those from the first in brackets on, "[ENVIRONMENT]", may be left out.
    std::vector<std::string> operand_names;
    std::vector<Option> options;

    /// Set by parse(): the operands, and the flags with their values, in order. Points into `options`.
    std::vector<std::string> operands;
    std::vector<std::pair<const Option*, std::string>> given;

    /// Split `argv` into operands and flags, without interpreting values.
    ///
    /// @param answer   set to the text to print, if the user asks for the help, the version, the man page or a
    ///                 completion script
    /// @returns false, with the reason in `error`, if a flag is unknown (the error suggests the closest one), a value
    ///          is missing, unexpected or empty (a recipe's key may be cleared), or there are too few or too many
    ///          operands
    bool parse(int argc, const char** argv, std::string& answer, std::string& error);

    /// Whether the first operand is a recipe of `stage`.
    bool given_recipe() const;
    /// Whether the flag of `form` is given.
    bool given_form() const;
    /// What is wrong with the other flags then, or "".
    std::string form_fault() const;

    /// That -o is not given.
    std::string missing_output() const { return "-o " + output_metavar + " is missing"; }

    /// How to call it, one form per line.
    std::vector<std::string> synopses() const;
    /// All options by heading, advanced ones last, under "Advanced:", then those of every executable, under "Help:".
    std::vector<Section> sections() const;

private:
    bool parse_flag(const char**& argument, const char** end, std::string& answer, std::string& error);
    bool check_operands(std::string& error) const;
};

} // namespace vmlight
