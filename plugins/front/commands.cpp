// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include <vmlight/base/format.h>
#include <vmlight/base/params.h>
#include <vmlight/cli/man_page.h>
#include <vmlight/version.h>

#include <algorithm>

namespace vmlight::front {
namespace {

constexpr const char* kPurpose = "light meshes with visibility maps";
constexpr const char* kExamples = "  vmlight bake hero.obj -o hero_vismap.exr\n"
                                  "  vmlight light hero_vismap.exr studio.hdr -o hero_lit.exr\n"
                                  "  vmlight frames hero.obj studio.hdr -o hero.png\n"
                                  "  vmlight help bake";

std::vector<std::string> words()
{
    std::vector<std::string> found;
    for (const Command& command : commands())
        found.emplace_back(command.word);
    return found;
}

std::string joined(const std::vector<std::string>& parts, const std::string& between)
{
    std::string text;
    for (const std::string& part : parts)
        text += (text.empty() ? "" : between) + part;
    return text;
}

// A line of each command; its pattern has {0} for the word, {1} for the executable, {2} for the help.
std::string for_each(const char* pattern)
{
    std::string text;
    for (const Command& command : commands())
        text += format(pattern, command.word, command.executable, command.help);
    return text;
}

// The scripts of the executables are beside this one.
std::string bash_script()
{
    return format(R"(# bash completion for vmlight
_vmlight()
{{
    local folder=${{BASH_SOURCE[0]%/*}} current=${{COMP_WORDS[COMP_CWORD]}} executable=
    COMPREPLY=()
    if ((COMP_CWORD == 1)); then
        COMPREPLY=($(compgen -W "{0} help --help --version" -- "$current"))
        return
    fi
    case ${{COMP_WORDS[1]}} in
    help)
        COMPREPLY=($(compgen -W "{0}" -- "$current"))
        return ;;
{1}    *)
        return ;;
    esac
    declare -F "_$executable" >/dev/null || . "$folder/$executable" || return
    local line=("$executable" "${{COMP_WORDS[@]:2}}") at=$((COMP_CWORD - 1))
    local COMP_WORDS=("${{line[@]}}") COMP_CWORD=$at
    "_$executable"
}}
complete -o filenames -F _vmlight vmlight
)",
                  joined(words(), " "), for_each("    {0}) executable={1} ;;\n"));
}

std::string zsh_script()
{
    return format(R"(#compdef vmlight
local -a commands
commands=(
{0})
local executable
if (( CURRENT == 2 )); then
    _describe command commands
    _arguments '--help[Print this help]' '--version[Print the version]'
    return
fi
case $words[2] in
help)
    _describe command commands
    return ;;
{1}*)
    return 1 ;;
esac
shift words
(( CURRENT-- ))
words[1]=$executable
_$executable
)",
                  for_each("    '{0}:{2}'\n"), for_each("{0}) executable={1} ;;\n"));
}

} // namespace

const std::vector<Command>& commands()
{
    static const std::vector<Command> all {
        { "bake", "makevismap", "Bake a visibility map of a mesh" },
        { "filter", "makecfem", "Filter an environment for diffuse lighting" },
        { "light", "makelightmap", "Light a visibility map with an environment" },
        { "frames", "vmframes", "Render pictures of a mesh" },
        { "view", "vmview", "Look at a lit mesh in a window" },
        { "cost", "vmcost", "Measure accuracy against time" },
        { "export", "vmexport", "Write textures for game engines, or a page" },
    };
    return all;
}

const Command* find_command(const std::string& word)
{
    const auto found
        = std::find_if(commands().begin(), commands().end(), [&](const Command& known) { return word == known.word; });
    return found == commands().end() ? nullptr : &*found;
}

std::string unknown_command(const std::string& word)
{
    const std::string near = nearest_name(word, words());
    return format("unknown command \"{}\"; {}commands: {}", word, near.empty() ? "" : format("did you mean {}? ", near),
                  joined(words(), ", "));
}

std::string help_text()
{
    return format("vmlight: {}\n(vmlight {})\n\nUsage: vmlight COMMAND [arguments]\n       vmlight help COMMAND\n\n"
                  "Commands, each an executable of its own:\n{}\nHelp:\n  --help      Print this help\n"
                  "  --version   Print the version\n\nExamples:\n{}\n\n"
                  "Exit status: that of the command; 2 on wrong usage.\n",
                  kPurpose, VMLIGHT_VERSION_STRING, for_each("  {0:<8}  {1:<12}  {2}\n"), kExamples);
}

std::string man_page()
{
    std::string text = format(".TH VMLIGHT 1 \"\" \"vmlight {}\" \"vmlight\"\n.SH NAME\nvmlight \\- {}\n"
                              ".SH SYNOPSIS\n.nf\nvmlight COMMAND [arguments]\nvmlight help COMMAND\n.fi\n"
                              ".SH COMMANDS\n",
                              VMLIGHT_VERSION_STRING, kPurpose);
    text += for_each(".TP\n\\fB{0}\\fR\n{2}: \\fB{1}\\fR(1)\n");
    text += ".SH OPTIONS\n.TP\n\\fB\\-\\-help\\fR\nPrint the help\n.TP\n\\fB\\-\\-version\\fR\nPrint the version\n";
    text += ".SH EXAMPLES\n.nf\n" + roff_text(kExamples) + "\n.fi\n";
    text += ".SH EXIT STATUS\nThat of the command; 2 on wrong usage\n.SH SEE ALSO\n";
    std::vector<std::string> pages;
    for (const Command& command : commands())
        pages.push_back(format("\\fB{}\\fR(1)", command.executable));
    return text + joined(pages, ",\n") + "\n";
}

bool completion(std::string& script, const std::string& shell, std::string& error)
{
    if (shell != "bash" && shell != "zsh") {
        error = format("print_completion: \"{}\" is not one of bash, zsh", shell);
        return false;
    }
    script = shell == "bash" ? bash_script() : zsh_script();
    return true;
}

} // namespace vmlight::front
