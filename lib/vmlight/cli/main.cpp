// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/main.h>

#include <vmlight/base/format.h>
#include <vmlight/base/interrupt.h>
#include <vmlight/base/parallel.h>
#include <vmlight/cli/early_answer.h>
#include <vmlight/cli/mesh_part_names.h>
#include <vmlight/image/image_file.h>
#include <vmlight/uv/udim.h>
#include <vmlight/vismap/basis.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/sysutil.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <system_error>
#include <thread>

#ifdef __linux__
#include <sys/prctl.h>
#endif

namespace vmlight {

StageMain::StageMain(std::string name, std::string purpose, std::vector<std::string> operands, std::string example,
                     OutputKind output)
{
    CommandLine& line = m_command.line;
    line.name = std::move(name);
    line.purpose = std::move(purpose);
    line.operand_names = std::move(operands);
    line.example = std::move(example);
    struct Output
    {
        const char *metavar, *help;
    };
    static const std::map<OutputKind, Output> outputs {
        { OutputKind::Image, { "OUTPUT.exr", "EXR image to write" } },
        { OutputKind::Folder, { "FOLDER", "Folder to write to" } },
        { OutputKind::OptionalFolder, { "FOLDER", "Folder to write textures to" } },
        { OutputKind::Picture,
          { "PICTURE",
            "Picture to write: .exr for scene-linear light, .png, .jpg, .webp or .tif "
            "as the display shows it, .gif or .mp4 for a film" } },
        { OutputKind::OptionalPicture,
          { "PICTURE",
            "Write a picture instead of opening a window: .exr for scene-linear light, .png, .jpg, .webp or .tif "
            "as the display shows it" } },
    };
    line.output_metavar = outputs.at(output).metavar;
    line.needs_output = output != OutputKind::OptionalPicture && output != OutputKind::OptionalFolder;
    m_command.output_kind = output;
    group(kOutputHeading);
    option("o", line.output_metavar, outputs.at(output).help, m_command.output);
    if (output != OutputKind::Folder && output != OutputKind::OptionalFolder)
        params(kOutputHeading, m_command.file);
    params(kOutputHeading, m_command.common);
}

void StageMain::drop(const std::string& name)
{
    auto& options = m_command.line.options;
    options.erase(std::remove_if(options.begin(), options.end(),
                                 [&](const CommandLine::Option& option) { return option.name == name; }),
                  options.end());
}

void StageMain::reword(const std::string& name, const std::string& help)
{
    for (CommandLine::Option& option : m_command.line.options)
        if (option.name == name)
            option.help = help;
}

void StageMain::accept_recipe(const char* stage, RecipeAccess access)
{
    m_command.line.stage = stage;
    m_command.line.is_recipe = [this](const std::string& name) { return recipe_stage(name) == m_command.line.stage; };
    m_command.recipe = std::move(access);
    m_command.line.options[0].help
        = format("EXR image to write; or a .{}, to save this command line as a recipe and make no image", stage);
    const auto take = [this](OIIO::string_view, std::string&) { return m_command.prints_recipe = true; };
    m_command.line.options.insert(m_command.line.options.begin() + 1,
                                  { kOutputHeading, "print_recipe", "",
                                    "Print this command line as a recipe on stdout, and make no image", take });
}

void StageMain::group(const std::string& heading)
{
    m_heading = heading;
}

void StageMain::option(const std::string& name, const std::string& metavar, const Help& help, Take take)
{
    m_command.line.options.push_back({ m_heading, name, metavar, help.text, std::move(take), help.is_advanced });
}

void StageMain::option(const std::string& name, const std::string& metavar, const Help& help, std::string& dst)
{
    option(name, metavar, help, [&dst](OIIO::string_view text, std::string&) {
        dst = std::string(text);
        return true;
    });
    m_command.line.options.back().allowed = Text {};
}

void StageMain::answer(const std::string& name, const Help& help,
                       std::function<bool(std::string& text, std::string& error)> print)
{
    option(name, "", help, [this, print = std::move(print)](OIIO::string_view, std::string&) {
        m_command.print = print;
        return true;
    });
}

void StageMain::form(const std::string& name, const std::string& operand, const Help& help, const std::string& reason)
{
    m_command.line.form = { name, operand, reason };
    option(name, "", help, [](auto, auto&) { return true; });
}

void StageMain::dry_run(const Help& help)
{
    option("dry_run", "", help, [this](auto, auto&) { return m_command.is_dry_run = true; });
}

void StageMain::unused(std::function<std::string(const std::string& name)> reason)
{
    m_command.recipe.unused_reason = std::move(reason);
}

void StageMain::check(std::function<std::string()> fault)
{
    m_command.checks.push_back(std::move(fault));
}

void StageMain::stay_up(std::set<std::string>& warned)
{
    m_warned = &warned;
    const auto& given = m_command.line.given;
    if (std::none_of(given.begin(), given.end(), [](const auto& flag) { return flag.first->name == "compression"; }))
        m_command.file.compression = "none";
}

void StageMain::settle_threads()
{
    int& threads = m_command.common.threads;
    if (threads > 0)
        OIIO::attribute("threads", threads);
    // OpenImageIO, OpenEXR and Embree each have a pool; OpenImageIO's begins with one thread per core.
    if (can_start_threads(3 * worker_count(threads) + int(std::thread::hardware_concurrency())))
        return;
    warn("too few threads can be started here (ulimit -u): one is used");
    threads = 1;
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", -1); // none but the caller's
}

bool StageMain::do_work(const std::function<bool(std::string& error)>& work, std::string& error)
{
    settle_threads();
    catch_interrupts(m_command.line.name, int(ExitCode::Failed));
    if (!has_udim_pattern(output()) && !mesh_part_pattern(output())) // otherwise each file is checked
        error = m_command.output_fault();
    if (interrupted()) // deferred while the output folder was checked
        error = "interrupted";
    if (const std::string warning = m_command.output_warning(); error.empty() && !warning.empty())
        warn(warning);
    if (!error.empty() || !work(error))
        return false;
    if (!m_warned)
        ignore_interrupts();
    return true;
}

int StageMain::run(int argc, const char** argv, const std::function<bool(std::string& error)>& work)
{
    prepare_streams();
#ifdef __linux__
    ::prctl(PR_SET_NAME, m_command.line.name.c_str()); // for ps, top and killall: the file has another name
#endif
    OIIO::Filesystem::convert_native_arguments(argc, argv);
    // Debian's OIIO 3 prints debug messages on stderr by default.
    if (OIIO::Sysutil::getenv("OPENIMAGEIO_DEBUG").empty())
        OIIO::attribute("debug", 0);
    std::string answer, error;
    ExitCode exit = ExitCode::Failed;
    try {
        exit = m_command.parse(argc, argv, answer, error);
        const bool only_prints = !answer.empty() || !m_command.makes_image(); // a recipe of defaults is empty
        if (exit == ExitCode::Done && m_command.print && !m_command.print(answer, error))
            exit = ExitCode::Failed;
        if (exit == ExitCode::Done && !only_prints)
            exit = do_work(work, error) ? ExitCode::Done : ExitCode::Failed;
        else if (exit == ExitCode::Done)
            exit = put(answer, error) ? ExitCode::Done : ExitCode::Failed;
    } catch (const std::system_error& exception) {
        // A thread could not be started. OIIO's thread pool is half constructed, and its destructor would crash.
        report("ERROR", exception.what());
        std::fflush(stdout);
        std::_Exit(int(ExitCode::Failed));
    } catch (const std::bad_alloc&) {
        error = "out of memory";
        exit = ExitCode::Failed;
    } catch (const std::exception& exception) {
        error = exception.what();
        exit = ExitCode::Failed;
    }
    error = with_flags(error);
    if (exit != ExitCode::Done)
        report("ERROR", exit == ExitCode::Usage ? usage_text(m_command.line, error) : error);
    return int(exit);
}

bool StageMain::write(const OIIO::ImageBuf& image, std::string& error)
{
    return write(image, output(), error);
}

bool StageMain::write(const OIIO::ImageBuf& image, const std::string& path, std::string& error)
{
    return write(OIIO::cspan<OIIO::ImageBuf>(&image, 1), path, error);
}

bool StageMain::write(OIIO::cspan<OIIO::ImageBuf> images, const std::string& path, std::string& error)
{
    for (const OIIO::ImageBuf& image : images)
        if (pixel_format() == "half" && !(error = half_fault(image.spec())).empty()) {
            error = format("\"{}\": {}", path, error);
            return false;
        }
    return write_images(
        images, path, m_command.file, [](double) { return !interrupted(); }, error);
}

} // namespace vmlight
