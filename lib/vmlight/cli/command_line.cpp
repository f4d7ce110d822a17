// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/command_line.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text.h>
#include <vmlight/cli/completion.h>
#include <vmlight/cli/flag_suggestion.h>
#include <vmlight/cli/flag_table.h>
#include <vmlight/cli/help_text.h>
#include <vmlight/cli/man_page.h>
#include <vmlight/version.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <map>

namespace vmlight {
namespace {

using Option = CommandLine::Option;

// Flags of every executable that print something instead of working. The last three are for programs: not in the help.
struct AnswerFlag
{
    Option option;
    bool is_hidden;
    bool (*answer)(std::string& dst, const CommandLine& line, const std::string& value, std::string& error);
};

const std::vector<AnswerFlag>& answer_flags()
{
    static const std::vector<AnswerFlag> flags {
        { { "Help:", "help", "", "Print this help" },
          false,
          [](std::string& dst, const CommandLine& line, const std::string&, std::string&) {
              dst = help_text(line);
              return true;
          } },
        { { "Help:", "version", "", "Print the version" },
          false,
          [](std::string& dst, const CommandLine&, const std::string&, std::string&) {
              dst = VMLIGHT_VERSION_STRING "\n";
              return true;
          } },
        { { "", "print_man", "", "Print the man page" },
          true,
          [](std::string& dst, const CommandLine& line, const std::string&, std::string&) {
              dst = man_page(line);
              return true;
          } },
        { { "", "print_completion", "SHELL", "Print the completion script for bash or zsh" }, true, print_completion },
        { { "", "print_flags", "", "Print the flags as JSON" },
          true,
          [](std::string& dst, const CommandLine& line, const std::string&, std::string&) {
              dst = flag_table(line);
              return true;
          } },
    };
    return flags;
}

// Other spellings, which people and scripts bring from other tools.
std::string main_spelling(const std::string& flag)
{
    static const std::map<std::string, std::string> spellings {
        { "-h", "--help" },          { "-help", "--help" }, { "-?", "--help" },  { "-V", "--version" },
        { "-version", "--version" }, { "--output", "-o" },  { "-output", "-o" },
    };
    const auto found = spellings.find(flag);
    return found == spellings.end() ? flag : found->second;
}

bool is_number(const std::string& text)
{
    double ignored = 0;
    std::string reason;
    return parse_value(ignored, text, Range { -1e300, 1e300 }, reason);
}

const AnswerFlag* find_answer_flag(const std::string& flag)
{
    for (const AnswerFlag& known : answer_flags())
        if (known.option.flag() == flag)
            return &known;
    return nullptr;
}

std::string unknown_flag(const std::string& flag, const CommandLine& line)
{
    std::vector<std::string> known;
    for (const CommandLine::Section& section : line.sections())
        for (const Option* option : section.options)
            known.push_back(option->flag());
    return format("unknown flag \"{}\"{}", flag, flag_suggestion(flag, known));
}

} // namespace

std::string flag_of(const std::string& name)
{
    return name.size() == 1 ? "-" + name : "--" + replaced(name, "_", "-");
}

bool CommandLine::given_recipe() const
{
    if (stage.empty() || operands.empty() || given_form())
        return false;
    return is_recipe ? is_recipe(operands[0]) : ends_with(in_small_letters(operands[0]), "." + stage);
}

bool CommandLine::given_form() const
{
    return std::any_of(given.begin(), given.end(),
                       [&](const auto& flag) { return !form.name.empty() && flag.first->name == form.name; });
}

std::string CommandLine::form_fault() const
{
    for (const auto& [option, text] : given)
        if (option->name != form.name && (option->heading != kOutputHeading || option->name == "print_recipe"))
            return format("{}: {}", option->flag(), form.reason);
    return "";
}

std::vector<std::string> CommandLine::synopses() const
{
    const std::string output = format(needs_output ? "-o {}" : "[-o {}]", output_metavar);
    std::vector<std::string> lines { format("{} {} {} [options]", name, OIIO::Strutil::join(operand_names, " "),
                                            output) };
    if (!stage.empty())
        lines.push_back(format("{} RECIPE.{} -o {} [options]", name, stage, output_metavar));
    if (!form.name.empty())
        lines.push_back(format("{} {} {}... -o {}", name, flag_of(form.name), form.operand, output_metavar));
    return lines;
}

std::vector<CommandLine::Section> CommandLine::sections() const
{
    std::vector<Section> found;
    const auto add = [&](const std::string& heading, const Option& option) {
        const auto same = [&](const Section& section) { return section.heading == heading; };
        const auto section = std::find_if(found.begin(), found.end(), same);
        (section == found.end() ? found.emplace_back(Section { heading, {} }) : *section).options.push_back(&option);
    };
    for (const bool advanced : { false, true })
        for (const Option& option : options)
            if (option.is_advanced == advanced)
                add(advanced ? "Advanced:" : option.heading, option);
    for (const AnswerFlag& flag : answer_flags())
        if (!flag.is_hidden)
            add(flag.option.heading, flag.option);
    return found;
}

// Takes --flag=value or --flag value. A value that is a word of its own may begin with '-'; one that may be left out is
// taken to be there if it is a number.
bool CommandLine::parse_flag(const char**& argument, const char** end, std::string& answer, std::string& error)
{
    const std::string word = *argument;
    const size_t equals = word.find('=');
    const std::string flag = main_spelling(word.substr(0, equals));
    const AnswerFlag* answering = find_answer_flag(flag);
    const auto found
        = std::find_if(options.begin(), options.end(), [&](const Option& option) { return option.flag() == flag; });
    if (!answering && found == options.end()) {
        error = unknown_flag(flag, *this);
        return false;
    }
    const Option& option = answering ? answering->option : *found;
    const bool may_lack = starts_with(option.metavar, "[");
    std::string value = option.metavar.empty() || may_lack ? "true" : "";
    if (option.metavar.empty() && equals != std::string::npos)
        error = format("{} takes no value", flag);
    else if (!option.metavar.empty() && !may_lack && equals == std::string::npos && argument + 1 == end)
        error = format("{} needs a value: {}", flag, option.metavar);
    else if (equals != std::string::npos)
        value = word.substr(equals + 1);
    else if (!option.metavar.empty() && (!may_lack || (argument + 1 < end && is_number(argument[1]))))
        value = *++argument;
    if (!error.empty())
        return false;
    if (answering)
        return answering->answer(answer, *this, value, error);
    given.emplace_back(&option, value);
    return true;
}

bool CommandLine::check_operands(std::string& error) const
{
    if (given_form()) {
        error = operands.empty() ? form.operand + " is missing" : "";
        return error.empty();
    }
    const bool takes_more = ends_with(operand_names.back(), "...");
    const size_t most = given_recipe() ? 1 : operand_names.size();
    size_t least = 0;
    while (least < most && !starts_with(operand_names[least], "["))
        ++least;
    if (operands.size() < least)
        error = format("{} is missing", operand_names[operands.size()]);
    else if (operands.size() > most && !takes_more)
        error = format("unexpected argument \"{}\"", operands[most]);
    return error.empty();
}

bool CommandLine::parse(int argc, const char** argv, std::string& answer, std::string& error)
{
    const char** const end = argv + argc;
    for (const char** argument = argv + 1; argument < end; ++argument) {
        const std::string word = *argument;
        if (word.size() < 2 || word[0] != '-')
            operands.push_back(word);
        else if (!parse_flag(argument, end, answer, error))
            return false;
        if (!answer.empty())
            return true;
    }
    if (!check_operands(error))
        return false;
    // Mostly an unset shell variable. With a recipe it clears the key.
    for (const auto& [option, value] : given)
        if (error.empty() && !given_recipe() && stripped(value).empty())
            error = format("{} has an empty value", option->flag());
    return error.empty();
}

} // namespace vmlight
