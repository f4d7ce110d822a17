// SPDX-License-Identifier: Apache-2.0
// What a user starts as makelightmap and the like: it answers what the flags alone can answer, and becomes the
// executable that does the work, and loads the libraries for it, for all else.
#include "start.h"

#include <vmlight/base/format.h>
#include <vmlight/base/interrupt.h>
#include <vmlight/cli/early_answer.h>
#include <vmlight/cli/flag_table.h>

#include <filesystem>
#include <system_error>

using namespace vmlight;

namespace {

// Written by the build: the table of the flags, and where an installed front finds what works, from its own folder.
constexpr const char* kFlagTable =
#include VMLIGHT_FLAG_TABLE
    ;
constexpr const char* kInstalled = VMLIGHT_WORK_FOLDER;
constexpr const char* kBuilt = "../libexec/vmlight";

std::string worker(const std::string& name)
{
    namespace fs = std::filesystem;
    const fs::path folder = front::own_folder(), file = name + ".bin";
    const std::string built = (folder / kBuilt / file).lexically_normal().string();
    std::error_code ignored;
    return fs::exists(built, ignored) ? built : (folder / kInstalled / file).lexically_normal().string();
}

int finish(const CommandLine& line, ExitCode code, const std::string& answer, std::string error)
{
    prepare_streams();
    if (code == ExitCode::Done && !print_answer(answer, error))
        code = ExitCode::Failed;
    if (code != ExitCode::Done)
        print_message(line, "ERROR", code == ExitCode::Usage ? usage_text(line, error) : error);
    return int(code);
}

} // namespace

int main(int argc, const char** argv)
{
    CommandLine line = read_flag_table(kFlagTable);
    std::string answer, error;
    if (const auto code = early_answer(line, argc, argv, answer, error))
        return finish(line, *code, answer, error);
    const std::string path = worker(line.name);
    error = front::start(path, argv);
    return finish(line, ExitCode::Failed, "", error + "; install vmlight as a whole");
}
