// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/help_text.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text.h>
#include <vmlight/version.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight {
namespace {

constexpr size_t kColumns = 79, kHelpColumn = 28;

// `text` after `label` at `indent`, wrapped and aligned at `column`; on a line of its own if the label is too long.
std::string entry(const std::string& label, size_t indent, const std::string& text, size_t column)
{
    std::string lines = std::string(indent, ' ') + label;
    size_t used = lines.size();
    const auto move_to_column = [&] {
        if (used + 1 > column) {
            lines += "\n";
            used = 0;
        }
        lines += std::string(column - used, ' ');
        used = column;
    };
    move_to_column();
    for (const std::string& word : split_words(text)) {
        if (used > column && used + 1 + word.size() > kColumns) {
            used = kColumns;
            move_to_column();
        } else if (used > column) {
            lines += " ";
            ++used;
        }
        lines += word;
        used += word.size();
    }
    return lines + "\n";
}

std::string option_text(const CommandLine::Option& option)
{
    const std::string label = option.metavar.empty() ? option.flag() : option.flag() + " " + option.metavar;
    std::string text = entry(label, 2, option.help, kHelpColumn);
    size_t longest = 0;
    for (const Choice& choice : option.choices)
        longest = std::max(longest, OIIO::string_view(choice.word).size());
    for (const Choice& choice : option.choices)
        text += entry(choice.word, kHelpColumn + 2, choice.meaning, kHelpColumn + 2 + longest + 2);
    return text;
}

} // namespace

std::string help_text(const CommandLine& line)
{
    std::string text = format("{}: {}\n(vmlight {})\n\nUsage: {}\n", line.name, line.purpose, VMLIGHT_VERSION_STRING,
                              OIIO::Strutil::join(line.synopses(), "\n       "));
    for (const CommandLine::Section& section : line.sections()) {
        text += "\n" + section.heading + "\n";
        for (const CommandLine::Option* option : section.options)
            text += option_text(*option);
    }
    return text
        + format("\nExamples:\n{}\n\nExit status: 0 on success, 1 if the job failed, 2 on wrong usage.\n",
                 line.example);
}

} // namespace vmlight
