// SPDX-License-Identifier: Apache-2.0
/// The command line of an executable: the flags and operands that it takes, the help that tells them, and what a user
/// gave.
#pragma once

#include <OpenImageIO/string_view.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace vmlight {

/// "-o" for "o", "--max-distance" for "max_distance".
std::string flag_of(const std::string& name);

struct CommandLine
{
    struct Option
    {
        /// The metavar of a flag that takes no value is empty. Options of one heading stand together in the help.
        std::string heading, name, metavar, help;
        /// Takes the flag's value ("true" for one without); false and `error` refuse it. For the caller to call.
        std::function<bool(OIIO::string_view text, std::string& error)> take;
    };

    /// For the help: of the executable, one sentence, one or more command lines, and what -o names.
    std::string name, purpose, example, output_metavar;
    /// "", or the stage of which one recipe may come in place of the operands.
    std::string stage;
    /// The last may end in "...": one or more.
    std::vector<std::string> operand_names;
    std::vector<Option> options;

    /// Set by parse(): the operands, and the flags with their values in the order they came. Points into `options`.
    std::vector<std::string> operands;
    std::vector<std::pair<const Option*, std::string>> given;

    /// Look at all words, and take none: what the values are is for `take` to tell. Help and the version go to stdout,
    /// and set `helped`.
    ///
    /// @returns false, with the reason in `error`, at an unknown flag (with the nearest), a missing value, one that
    ///          is too many or empty (where no recipe is given, whose key it would clear), or operands that are too few
    ///          or too many.
    bool parse(int argc, const char** argv, bool& helped, std::string& error);

    /// Whether the first operand is a recipe of `stage`.
    bool given_recipe() const;

private:
    std::vector<std::string> flags() const;
    bool split_arguments(int argc, const char** argv, std::vector<std::string>& words, std::string& error) const;
    bool parse_words(const std::vector<std::string>& words, bool& helped, std::string& error);
    bool takes_more() const;
};

} // namespace vmlight
