// SPDX-License-Identifier: Apache-2.0
// What an executable prints.
#include <vmlight/cli/main.h>

#include <vmlight/base/interrupt.h>
#include <vmlight/base/output_file.h>
#include <vmlight/cli/early_answer.h>
#include <vmlight/cli/progress_line.h>

#include <algorithm>
#include <cstdio>

namespace vmlight {

// The library says "NAME: " and "set NAME to" of parameters, which have flags here; but inputs may be operands.
std::string StageMain::with_flags(std::string error) const
{
    const std::string first = error.substr(0, error.find(": "));
    if (m_command.is_given(first))
        error.replace(0, first.size(), flag_of(first));
    static const std::string before = "; set ", after = " to ";
    const size_t start = error.rfind(before);
    if (start == std::string::npos)
        return error;
    const size_t name = start + before.size(), end = std::min(error.find(after, name), error.size());
    const std::string parameter = error.substr(name, end - name);
    return m_command.has(parameter) ? error.substr(0, name) + flag_of(parameter) + error.substr(end) : error;
}

// Saves the recipe, or prints what is asked for instead of work.
bool StageMain::put(const std::string& answer, std::string& error) const
{
    if (m_command.saves_recipe())
        return write_file(output(), answer, error);
    return print_answer(answer, error);
}

MakeOptions StageMain::make_options()
{
    MakeOptions options;
    if (m_command.line.given_recipe())
        options.chain.push_back(operands()[0]);
    options.threads = m_command.common.threads;
    options.progress = [this](const std::string& step, int64_t texels) { return progress(step, texels); };
    options.say = [this](const std::string& line) { say(line); };
    options.answer = [this](const std::string& line) { answer(line); };
    options.warn = [this](const std::string& line) { warn(line); };
    return options;
}

Progress StageMain::progress(const std::string& step, int64_t texels)
{
    if (m_command.common.quiet)
        return [](double) { return !interrupted(); };
    return progress_on_stderr(step, texels, [] { return !interrupted(); });
}

void StageMain::report(const char* severity, const std::string& text) const
{
    print_message(m_command.line, severity, text);
}

void StageMain::say(const std::string& line) const
{
    if (!is_silent())
        answer(line);
}

void StageMain::answer(const std::string& line) const
{
    std::printf("%s\n", line.c_str());
    std::fflush(stdout); // in a pipe or log, warnings keep their place among these lines
}

void StageMain::warn(const std::string& line) const
{
    const bool is_new = !m_warned || m_warned->insert(line).second;
    if (is_new || !m_is_repeated)
        report("WARNING", with_flags(line));
}

} // namespace vmlight
