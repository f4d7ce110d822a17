// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/main.h>

#include <vmlight/base/interrupt.h>
#include <vmlight/base/output_file.h>
#include <vmlight/base/utf8.h>
#include <vmlight/base/words.h>
#include <vmlight/cli/command_line.h>
#include <vmlight/cli/progress_line.h>
#include <vmlight/image/image_file.h>
#include <vmlight/uv/udim.h>
#include <vmlight/vismap/basis.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>
#include <OpenImageIO/sysutil.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <system_error>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

struct FormatParams
{
    std::string format = "float";

    template <class Visit> void visit(Visit&& field)
    {
        field("format", format, Choices { { "float", "half" } }, "Numbers in the file");
    }
};

struct RunParams
{
    int threads = 0;
    bool quiet = false;

    template <class Visit> void visit(Visit&& field)
    {
        field("threads", threads, Range { 0, 1024 }, "Threads; 0 is one for each core");
        field("quiet", quiet, Flag {}, "Say nothing but warnings and errors");
    }
};

} // namespace

struct StageMain::State
{
    CommandLine line;
    RecipeDoor door { "", {}, {}, {}, [] { return std::string(); }, {}, [](const auto&) { return std::string(); } };
    std::vector<std::function<std::string()>> checks;
    bool prints_recipe = false;
    std::string heading, output;
    OutputKind kind;
    FormatParams file;
    RunParams common;

    void message(const char* kind, const std::string& text) const
    {
        end_progress_line();
        std::fprintf(stderr, "%s %s: %s\n", line.name.c_str(), kind, one_line(text).c_str());
    }
    std::string output_name_fault() const
    {
        return kind == OutputKind::Folder ? "" : vmlight::output_name_fault(output);
    }
    std::string output_fault() const
    {
        return kind == OutputKind::Folder ? output_folder_fault(output) : vmlight::output_fault(output);
    }
    std::string unsaid() const;
    Exit settle(int argc, const char** argv, bool& helped, std::string& error);
};

// What a recipe cannot hold.
std::string StageMain::State::unsaid() const
{
    std::vector<std::string> texts = line.operands;
    for (const auto& [option, text] : line.given)
        texts.push_back(text);
    for (const std::string& text : texts)
        if (!is_utf8(text))
            return format("\"{}\": a recipe is UTF-8, which this is not", text);
    return door.unsaid ? door.unsaid() : "";
}

// The recipe or the operands first, then the flags, which override them.
Exit StageMain::State::settle(int argc, const char** argv, bool& helped, std::string& error)
{
    if (!line.parse(argc, argv, helped, error))
        return Exit::Usage;
    if (helped)
        return Exit::Done;
    if (line.given_recipe() && has_udim_pattern(recipe_path(line.operands[0]))) {
        error = format("\"{}\": one recipe makes all tiles: <UDIM> goes into the paths within it", line.operands[0]);
        return Exit::Usage;
    }
    std::string fault_of_file; // the work tells it, with its line
    if (line.given_recipe()) {
        if (!door.read(line.operands[0], error))
            return Exit::Failed;
        fault_of_file = door.fault();
    } else if (door.fill) {
        door.fill(line.operands);
    }
    for (const auto& [option, text] : line.given)
        if (!option->take(text, error))
            return Exit::Usage;
    if (prints_recipe)
        error = unsaid();
    if (!prints_recipe)
        error = output.empty() ? format("-o {} is missing", line.output_metavar) : output_name_fault();
    if (error.empty() && door.fault() != fault_of_file)
        error = door.fault();
    for (const auto& [option, text] : line.given)
        if (const std::string reason = door.unused(option->name); error.empty() && !reason.empty())
            error = format("{}{}: {}", flag_of(option->name), option->metavar.empty() ? "" : " " + text, reason);
    for (const auto& check : checks)
        if (error.empty() && !prints_recipe)
            error = check();
    return error.empty() ? Exit::Done : Exit::Usage;
}

StageMain::StageMain(std::string name, std::string purpose, std::vector<std::string> operands, std::string example,
                     OutputKind output)
    : m_state(std::make_unique<State>())
{
    CommandLine& line = m_state->line;
    line.name = std::move(name);
    line.purpose = std::move(purpose);
    line.operand_names = std::move(operands);
    line.example = std::move(example);
    line.output_metavar = output == OutputKind::Folder ? "FOLDER" : "OUTPUT.exr";
    m_state->kind = output;
    group("Output:");
    option("o", line.output_metavar, output == OutputKind::Folder ? "The folder to write to" : "The image to write",
           m_state->output);
    if (output == OutputKind::Image)
        params("Output:", m_state->file);
    params("Output:", m_state->common);
}

StageMain::~StageMain() = default;

bool StageMain::has_option(const std::string& name) const
{
    return std::any_of(m_state->line.options.begin(), m_state->line.options.end(),
                       [&](const CommandLine::Option& option) { return option.name == name; });
}

void StageMain::take_recipe(RecipeDoor door)
{
    m_state->line.stage = door.stage;
    m_state->door = std::move(door);
    const auto take = [this](OIIO::string_view, std::string&) { return m_state->prints_recipe = true; };
    m_state->line.options.insert(
        m_state->line.options.begin() + 1,
        { "Output:", "print_recipe", "", "Write the recipe of this command line to stdout, and do no more", take });
}

void StageMain::group(const std::string& heading)
{
    m_state->heading = heading;
}

void StageMain::option(const std::string& name, const std::string& metavar, const std::string& help, Take take)
{
    m_state->line.options.push_back({ m_state->heading, name, metavar, help, std::move(take) });
}

void StageMain::option(const std::string& name, const std::string& metavar, const std::string& help, std::string& dst)
{
    option(name, metavar, help, [&dst](OIIO::string_view text, std::string&) {
        dst = std::string(text);
        return true;
    });
}

void StageMain::check(std::function<std::string()> fault)
{
    m_state->checks.push_back(std::move(fault));
}

int StageMain::run(int argc, const char** argv, const std::function<bool(std::string& error)>& work)
{
    settle_streams();
    OIIO::Filesystem::convert_native_arguments(argc, argv);
    // Debian builds OIIO 3 to tell its inner doings on stderr: only for who asks.
    if (OIIO::Sysutil::getenv("OPENIMAGEIO_DEBUG").empty())
        OIIO::attribute("debug", 0);
    State& state = *m_state;
    std::string error;
    Exit exit = Exit::Failed;
    try {
        bool helped = false;
        exit = state.settle(argc, argv, helped, error);
        if (exit == Exit::Done && !helped && state.prints_recipe) {
            const std::string text = state.door.text();
            if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
                error = "cannot write to stdout";
                exit = Exit::Failed;
            }
        } else if (exit == Exit::Done && !helped) {
            if (state.common.threads > 0)
                OIIO::attribute("threads", state.common.threads);
            catch_interrupts(state.line.name, int(Exit::Failed));
            exit = Exit::Failed;
            if (!has_udim_pattern(state.output)) // else each tile's file is looked at
                error = state.output_fault();
            if (interrupted()) // which waited for the look at the folder
                error = "interrupted";
            exit = error.empty() && work(error) ? Exit::Done : Exit::Failed;
            if (exit == Exit::Done)
                ignore_interrupts();
        }
    } catch (const std::system_error& exception) {
        // A thread could not be started: the pool it was for is half made, and its destructor would crash.
        state.message("ERROR", exception.what());
        std::fflush(stdout);
        std::_Exit(int(Exit::Failed));
    } catch (const std::bad_alloc&) {
        error = "out of memory";
    } catch (const std::exception& exception) {
        error = exception.what();
    }
    if (exit != Exit::Done)
        state.message("ERROR", exit == Exit::Usage ? error + " (see " + state.line.name + " --help)" : error);
    return int(exit);
}

const std::string& StageMain::pixel_format() const
{
    return m_state->file.format;
}

const std::string& StageMain::output() const
{
    return m_state->output;
}

const std::vector<std::string>& StageMain::operands() const
{
    return m_state->line.operands;
}

MakeOptions StageMain::make_options()
{
    MakeOptions options;
    if (m_state->line.given_recipe())
        options.chain.push_back(m_state->line.operands[0]);
    options.threads = m_state->common.threads;
    options.progress = [this](const std::string& step, int64_t texels) { return progress(step, texels); };
    options.say = [this](const std::string& line) { say(line); };
    options.warn = [this](const std::string& line) { warn(line); };
    return options;
}

Progress StageMain::progress(const std::string& step, int64_t texels)
{
    if (m_state->common.quiet)
        return [](double) { return !interrupted(); };
    return progress_on_stderr(step, texels, [] { return !interrupted(); });
}

void StageMain::say(const std::string& line) const
{
    if (!m_state->common.quiet)
        std::printf("%s\n", line.c_str());
}

void StageMain::warn(const std::string& line) const
{
    m_state->message("WARNING", line);
}

bool StageMain::write(const OIIO::ImageBuf& image, std::string& error)
{
    return write(image, m_state->output, error);
}

bool StageMain::write(const OIIO::ImageBuf& image, const std::string& path, std::string& error)
{
    return write(OIIO::cspan<OIIO::ImageBuf>(&image, 1), path, error);
}

bool StageMain::write(OIIO::cspan<OIIO::ImageBuf> images, const std::string& path, std::string& error)
{
    for (const OIIO::ImageBuf& image : images)
        if (m_state->file.format == "half" && !(error = half_fault(image.spec())).empty()) {
            error = OIIO::Strutil::fmt::format("\"{}\": {}", path, error);
            return false;
        }
    return write_images(
        images, path, m_state->file.format, [](double) { return !interrupted(); }, error);
}

} // namespace vmlight
