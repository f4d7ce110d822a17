// SPDX-License-Identifier: Apache-2.0
// `vmlight WORD ...` becomes the executable that the word stands for.
#include "commands.h"
#include "start.h"

#include <vmlight/base/format.h>
#include <vmlight/base/interrupt.h>
#include <vmlight/base/params.h>
#include <vmlight/cli/early_answer.h>
#include <vmlight/version.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

using namespace vmlight;
using namespace vmlight::front;

namespace {

// Returns only on failure, with the reason.
std::string become(const Command& command, std::vector<const char*> words)
{
    words.insert(words.begin(), command.executable);
    words.push_back(nullptr);
    const std::string beside = (std::filesystem::path(own_folder()) / command.executable).string();
    std::error_code ignored;
    if (std::filesystem::exists(beside, ignored))
        return start(beside, words.data());
    const std::string fault = start_from_path(command.executable, words.data());
    return format("{}; it is neither beside vmlight nor in $PATH", fault);
}

// Sets `answer`, or returns what is wrong with the usage.
std::string answer_flag(std::string& answer, const std::vector<const char*>& words)
{
    const std::string flag = words[0], value = words.size() > 1 ? words[1] : "";
    std::string error;
    if (flag == "--help" || flag == "-h" || flag == "-help" || flag == "-?" || flag == "help")
        answer = help_text();
    else if (flag == "--version" || flag == "-V" || flag == "-version")
        answer = VMLIGHT_VERSION_STRING "\n";
    else if (flag == "--print-man")
        answer = man_page();
    else if (flag == "--print-completion")
        completion(answer, value, error);
    else if (flag[0] == '-') {
        const std::string near = nearest_name(flag, { "--help", "--version" });
        error = format("unknown flag \"{}\"{}; the flags of a command follow it", flag,
                       near.empty() ? "" : format("; did you mean {}?", near));
    } else
        error = unknown_command(flag);
    return error;
}

} // namespace

int main(int argc, const char** argv)
{
    CommandLine line;
    line.name = "vmlight";
    std::vector<const char*> words(argv + std::min(1, argc), argv + argc);
    const bool asks = words.size() > 1 && std::string(words[0]) == "help";
    const Command* command = words.empty() ? nullptr : find_command(words[asks ? 1 : 0]);
    std::string answer, error;
    ExitCode code = ExitCode::Usage;
    if (command) {
        words.erase(words.begin());
        error = become(*command, asks ? std::vector<const char*> { "--help" } : words);
        code = ExitCode::Failed;
    } else if (words.empty()) {
        error = "COMMAND is missing";
    } else if (asks) {
        error = unknown_command(words[1]);
    } else {
        error = answer_flag(answer, words);
    }
    prepare_streams();
    if (error.empty())
        code = print_answer(answer, error) ? ExitCode::Done : ExitCode::Failed;
    if (!error.empty())
        print_message(line, "ERROR", code == ExitCode::Usage ? usage_text(line, error) : error);
    return int(code);
}
