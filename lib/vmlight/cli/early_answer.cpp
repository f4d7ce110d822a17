// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/early_answer.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/cli/progress_line.h>

#include <algorithm>
#include <cstdio>

namespace vmlight {

std::optional<ExitCode> early_answer(CommandLine& line, int argc, const char** argv, std::string& answer,
                                     std::string& error)
{
    // What is a ?query and what a part of a file's name, the files decide.
    if (std::any_of(argv + std::min(1, argc), argv + argc, [](OIIO::string_view word) {
            return word.size() > 2 && word.find('?', 1) != OIIO::string_view::npos;
        }))
        return {};
    if (!line.parse(argc, argv, answer, error))
        return ExitCode::Usage;
    if (!answer.empty())
        return ExitCode::Done;
    if (line.given_recipe() || line.given_form())
        return {};
    bool has_output = false;
    for (const auto& [option, text] : line.given) {
        if (std::holds_alternative<std::monostate>(option->allowed))
            return {};
        if (!is_allowed(text, option->allowed, error)) {
            error = option->flag() + ": " + error;
            return ExitCode::Usage;
        }
        has_output = has_output || option->name == "o";
    }
    if (!line.needs_output || has_output)
        return {};
    error = line.missing_output();
    return ExitCode::Usage;
}

bool print_answer(const std::string& answer, std::string& error)
{
    if (std::fputs(answer.c_str(), stdout) >= 0 && std::fflush(stdout) == 0)
        return true;
    error = "cannot write to stdout";
    return false;
}

void print_message(const CommandLine& line, const char* severity, const std::string& text)
{
    end_progress_line();
    std::fprintf(stderr, "%s %s: %s\n", line.name.c_str(), severity, printable_line(text).c_str());
}

std::string usage_text(const CommandLine& line, const std::string& error)
{
    return error + " (see " + line.name + " --help)";
}

} // namespace vmlight
