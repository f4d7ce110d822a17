// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/command_line.h>

#include <vmlight/base/params.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/version.h>

#include <OpenImageIO/argparse.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

} // namespace

std::string flag_of(const std::string& name)
{
    return name.size() == 1 ? "-" + name : "--" + OIIO::Strutil::replace(name, "_", "-", true);
}

std::vector<std::string> CommandLine::flags() const
{
    std::vector<std::string> all { "--help", "--version" };
    for (const Option& option : options)
        all.push_back(flag_of(option.name));
    return all;
}

bool CommandLine::takes_more() const
{
    return OIIO::Strutil::ends_with(operand_names.back(), "...");
}

bool CommandLine::given_recipe() const
{
    return !stage.empty() && !operands.empty() && recipe_stage(operands[0]) == stage;
}

// ArgParse takes neither --flag=value nor tells an unknown flag from a missing one's nearest name: both are done first.
bool CommandLine::split_arguments(int argc, const char** argv, std::vector<std::string>& words,
                                  std::string& error) const
{
    const std::vector<std::string> known = flags();
    words.push_back(argc > 0 ? argv[0] : name);
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word.size() < 2 || word[0] != '-') {
            words.push_back(word);
            continue;
        }
        const size_t equals = word.find('=');
        const std::string flag = word.substr(0, equals);
        if (std::find(known.begin(), known.end(), flag) == known.end()) {
            const std::string near = nearest_name(flag, known);
            error = format("unknown flag \"{}\"{}", flag, near.empty() ? "" : format("; did you mean {}?", near));
            return false;
        }
        words.push_back(flag);
        if (equals != std::string::npos)
            words.push_back(word.substr(equals + 1));
        for (const Option& option : options) {
            const bool takes_value = !option.metavar.empty();
            if (flag_of(option.name) != flag || (!takes_value && equals == std::string::npos))
                continue;
            if (!takes_value) {
                error = format("{} takes no value", flag);
                return false;
            }
            if (equals == std::string::npos && i + 1 < argc)
                words.push_back(argv[++i]); // as it is, though it may begin with '-'
        }
    }
    return true;
}

bool CommandLine::parse_words(const std::vector<std::string>& words, bool& helped, std::string& error)
{
    OIIO::ArgParse parser;
    parser.intro(format("{}: {}\n(vmlight {})", name, purpose, VMLIGHT_VERSION_STRING));
    std::string usage = format("{} {} -o {} [options]", name, OIIO::Strutil::join(operand_names, " "), output_metavar);
    if (!stage.empty())
        usage += format("\n       {} RECIPE.{} -o {} [options]", name, stage, output_metavar);
    parser.usage(usage);
    parser.epilog(format("Example:\n{}\nExit code 0: done, 1: the work failed, 2: wrong usage.\n", example));
    parser.exit_on_error(false);
    parser.add_help(true);
    parser.add_version(VMLIGHT_VERSION_STRING);
    parser.arg("operand").hidden().action([&](OIIO::cspan<const char*> argv) { operands.push_back(argv[0]); });
    std::string heading;
    for (const Option& option : options) {
        if (option.heading != heading)
            parser.separator(heading = option.heading);
        const std::string flag = flag_of(option.name);
        // Metavars follow a colon and end at the next blank.
        const std::string metavar = OIIO::Strutil::replace(option.metavar, " ", "_", true);
        parser.arg((option.metavar.empty() ? flag : flag + " %s:" + metavar).c_str())
            .help(option.help)
            .action([this, &option](OIIO::cspan<const char*> argv) {
                given.emplace_back(&option, argv.size() > 1 ? argv[1] : "true");
            });
    }
    std::vector<const char*> pointers;
    for (const std::string& word : words)
        pointers.push_back(word.c_str());
    const int result = parser.parse_args(int(pointers.size()), pointers.data());
    helped = parser.aborted();
    if (helped)
        return true;
    const size_t wanted = given_recipe() ? 1 : operand_names.size();
    if (result < 0)
        error = parser.geterror();
    else if (operands.size() < wanted || (operands.size() > wanted && !takes_more()))
        error = operands.size() < wanted ? format("{} is missing", operand_names[operands.size()])
                                         : format("\"{}\" is one argument too many", operands[wanted]);
    return error.empty();
}

bool CommandLine::parse(int argc, const char** argv, bool& helped, std::string& error)
{
    std::vector<std::string> words;
    if (!split_arguments(argc, argv, words, error) || !parse_words(words, helped, error))
        return false;
    // Mostly a shell's variable that is not set. Of a recipe's keys it clears one.
    for (const auto& [option, value] : given)
        if (error.empty() && !helped && !given_recipe() && OIIO::Strutil::strip(value).empty())
            error = format("{} has an empty value", flag_of(option->name));
    return error.empty();
}

} // namespace vmlight
