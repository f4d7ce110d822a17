// SPDX-License-Identifier: Apache-2.0
// Disks that fail while a file is written, and recipes that are written.
#include "cases.h"
#include "failing_calls.h"
#include "files.h"
#include "hard_case.h"

#include <vmlight/base/format.h>

#include <algorithm>
#include <csignal>
#include <sys/resource.h>

using namespace vmlight;

namespace {

// Each stage, images of one and of several parts, and a recipe. They run thousands of times, and what is tested is how
// they write: the bake takes one ray a texel, and no neighbours.
const std::pair<const char*, const char*> kRuns[] = {
    { "x.exr", "makevismap quad.obj --resolution 16 --samples 1 --reconstruct off --quiet -o x.exr" },
    { "x.exr", "makecfem sky.exr --resolution 8 --quiet -o x.exr" },
    { "x.exr", "makecfem sky.exr --resolution 8 --stack --format half --quiet -o x.exr" },
    { "x.exr", "makelightmap vm.exr cfem.exr --quiet -o x.exr" },
    { "x.lightmap", "makelightmap vm.exr cfem.exr --quiet -o x.lightmap" },
};

// The limit of a file's size, which stands for the space on a disk.
class FileLimit
{
public:
    explicit FileLimit(size_t bytes)
    {
        EXPECT_EQ(::getrlimit(RLIMIT_FSIZE, &m_before), 0);
        const rlimit limit { bytes, m_before.rlim_max };
        EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
    }
    FileLimit(const FileLimit&) = delete;
    ~FileLimit() { EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &m_before), 0); }

private:
    rlimit m_before;
};

} // namespace

TEST_F(Files, EachCallThatWritesFails)
{
    HardCase row(
        "Each call that writes an output fails in turn, in all stages, for images of one and of several parts");
    // Of all calls, or of one in seven and the last ten.
    const auto fail_each = [&](const std::string& name, const std::string& line, bool all, bool all_after) {
        const std::string old = "the old file";
        int calls = 0;
        write(name, old);
        {
            const FailingCalls counted(FailingCalls::Files, 0);
            done(line);
            calls = counted.count();
        }
        const std::string fresh = read(name);
        EXPECT_GT(calls, 4);
        const auto before = names();
        int accepted = 0;
        const int step = all ? cases(1, 7) : cases(7, 31), last_ten = calls - 10;
        for (int call = 1; call <= calls; call = call < last_ten ? std::min(call + step, last_ten) : call + 1) {
            set_current_case(format("{}: call {} of {}", line, call, calls));
            restart_watchdog();
            write(name, old);
            const Result result = [&] {
                const FailingCalls failing(FailingCalls::Files, call, all_after);
                return run(line);
            }();
            const std::string seen = read(name);
            if (result.code == 0) { // a file without a name that could not be had, for which there is another way
                EXPECT_TRUE(seen == fresh) << call;
            } else {
                expect_one_error(result, 1, name);
                EXPECT_TRUE(seen == old || seen == fresh) << call;
            }
            EXPECT_EQ(names(), before) << "debris of call " << call;
            accepted += result.code == 0;
        }
        set_current_case("");
        EXPECT_LE(accepted, all_after ? 0 : 4) << "only opening a file may fail unseen";
    };
    for (const auto& [name, line] : kRuns) {
        fail_each(name, line, true, false);
        fail_each(name, line, false, true);
        const NoUnnamedFiles elsewhere;
        fail_each(name, line, false, false);
        const FailingCalls bytewise(FailingCalls::ShortWrites, 1, true);
        const std::string whole = read(name);
        done(line);
        EXPECT_TRUE(read(name) == whole);
        remove(name);
    }
    row.naive("a failure inside a seek is lost: half a file replaces the old one, with exit code 0");
    row.ours("the old file or the whole new one, and exit code 1 unless it is there");
}

TEST_F(Files, DiskFullAnywhere)
{
    HardCase row("The disk is full after any number of bytes, in all stages");
    for (const auto& [name, line] : kRuns) {
        done(line);
        const std::string fresh = read(name), old = "the old file";
        const auto before = names();
        // The last 4 KiB are what a buffer holds. 13 parts them and all that is before at odd places.
        for (size_t limit = 0; limit <= fresh.size();
             limit += limit + 4200 < fresh.size() ? cases(997, 4001) : cases(13, 101)) {
            set_current_case(format("{}: {} bytes", line, limit));
            restart_watchdog();
            write(name, old);
            Result result;
            {
                const FileLimit full(limit);
                result = run(line);
            }
            EXPECT_EQ(result.code, limit == fresh.size() ? 0 : 1) << limit;
            EXPECT_TRUE(read(name) == (result.code == 0 ? fresh : old)) << limit;
            EXPECT_EQ(names(), before) << "debris";
        }
        set_current_case("");
        remove(name);
    }
    row.naive("within the last 4 KiB: half a file replaces the old one, with exit code 0");
    row.ours("exit code 1 with the reason; the old file is untouched");
}
