// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/completion.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text.h>

#include <OpenImageIO/strutil.h>

namespace vmlight {
namespace {

using OIIO::Strutil::join;
using Option = CommandLine::Option;

std::vector<const Option*> all_options(const CommandLine& line)
{
    std::vector<const Option*> found;
    for (const CommandLine::Section& section : line.sections())
        found.insert(found.end(), section.options.begin(), section.options.end());
    return found;
}

std::string words_of(const Option& option)
{
    std::vector<std::string> words;
    for (const Choice& choice : option.choices)
        words.emplace_back(choice.word);
    return join(words, " ");
}

bool takes_list(const Option& option)
{
    return ends_with(option.metavar, ",...");
}

// What follows `previous`: words, or file names (no words), or nothing that can be known.
std::string bash_case(const Option& option)
{
    if (option.metavar.empty() || option.takes_file())
        return "";
    if (option.choices.empty())
        return format("    {})\n        return ;;\n", option.flag());
    return format("    {})\n{}        words=\"{}\" ;;\n", option.flag(),
                  takes_list(option) ? "        [[ $current != *,* ]] || prefix=${current%,*},\n" : "",
                  words_of(option));
}

// bash splits words at '=', which may be the last of them.
std::string bash_script(const CommandLine& line)
{
    std::vector<std::string> flags, files;
    std::string cases;
    for (const Option* option : all_options(line)) {
        flags.push_back(option->flag());
        cases += bash_case(*option);
        if (option->takes_file())
            files.push_back(option->flag());
    }
    return format(R"(# bash completion for {0}
_{0}()
{{
    local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} words= prefix= word
    COMPREPLY=()
    if [[ $current == = ]]; then
        current=
    elif [[ $previous == = ]]; then
        previous=${{COMP_WORDS[COMP_CWORD - 2]}}
    fi
    case $previous in
    {1})
        COMPREPLY=($(compgen -f -- "$current"))
        return ;;
{2}    esac
    if [[ -z $words && $current == -* ]]; then
        words="{3}"
    elif [[ -z $words ]]; then
        COMPREPLY=($(compgen -f -- "$current"))
        return
    fi
    for word in $words; do
        [[ $prefix$word != "$current"* ]] || COMPREPLY+=("$prefix$word")
    done
}}
complete -o filenames -F _{0} {0}
)",
                  line.name, join(files, " | "), cases, join(flags, " "));
}

// Text in a single-quoted argument of _arguments, whose fields end at ':' and ']'.
std::string zsh_text(std::string text)
{
    for (const char* special : { "\\", ":", "[", "]" })
        text = replaced(text, special, format("\\{}", special));
    return replaced(text, "'", "'\\''");
}

std::string zsh_action(const Option& option)
{
    if (option.choices.empty())
        return option.takes_file() ? "_files" : "";
    if (takes_list(option))
        return "_sequence compadd - " + words_of(option);
    std::vector<std::string> words;
    for (const Choice& choice : option.choices)
        words.push_back(format("{}\\:\"{}\"", choice.word, zsh_text(choice.meaning)));
    return "((" + join(words, " ") + "))";
}

std::string zsh_script(const CommandLine& line)
{
    std::vector<std::string> lines;
    for (const Option* option : all_options(line)) {
        std::string spec = format("    '{}{}{}[{}]", option->is_repeatable ? "*" : "", option->flag(),
                                  option->metavar.empty()       ? ""
                                      : option->name.size() > 1 ? "="
                                                                : "",
                                  zsh_text(option->help));
        if (!option->metavar.empty())
            spec += format(":{}:{}", zsh_text(option->metavar), zsh_action(*option));
        lines.push_back(spec + "'");
    }
    lines.push_back("    '*:file:_files'");
    return format("#compdef {}\n_arguments \\\n{}\n", line.name, join(lines, " \\\n"));
}

} // namespace

bool print_completion(std::string& script, const CommandLine& line, const std::string& shell, std::string& error)
{
    if (shell != "bash" && shell != "zsh") {
        error = format("print_completion: \"{}\" is not one of bash, zsh", shell);
        return false;
    }
    script = shell == "bash" ? bash_script(line) : zsh_script(line);
    return true;
}

} // namespace vmlight
