// SPDX-License-Identifier: Apache-2.0
// Hard machines: runs that are killed, and several that write one target. Each run is a fork of this process, in which
// all libraries are loaded: a kill then falls on the run's own work, not on the loader's. No test here may run anything
// in this process itself, since a fork has none of the threads that were started before it. (What takes another kind of
// process is in machine_test.py.)
#include "command_test.h"
#include "hard_case.h"
#include "mains.h"

#include <chrono>
#include <random>
#include <thread>

#include <csignal>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace vmlight;
using Clock = std::chrono::steady_clock;

namespace {

class Machine : public CommandTest
{
protected:
    /// Starts makevismap of spot.obj, quietly.
    static pid_t start(const std::string& resolution, const std::string& samples, const std::string& output)
    {
        const pid_t child = ::fork();
        if (child != 0)
            return child;
        const int nowhere = ::open("/dev/null", O_WRONLY);
        ::dup2(nowhere, STDOUT_FILENO);
        ::dup2(nowhere, STDERR_FILENO);
        const char* words[] = { "makevismap",    kSpot.c_str(), "--resolution", resolution.c_str(), "--samples",
                                samples.c_str(), "--quiet",     "-o",           output.c_str(),     nullptr };
        ::_exit(makevismap_main(9, words));
    }
    /// Returns the exit code, or the negative number of the signal that ended it.
    static int wait(pid_t child)
    {
        int status = 0;
        EXPECT_EQ(::waitpid(child, &status, 0), child);
        return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
    }
};

} // namespace

TEST_F(Machine, KilledAtAnyMoment)
{
    HardCase row("A run killed (`kill -9`, Ctrl-C) at 100 moments, from start to end");
    const std::string old = "the old picture";
    const Clock::time_point begin = Clock::now();
    ASSERT_EQ(wait(start("384", "4", "new.exr")), 0);
    const std::chrono::duration<double> whole = Clock::now() - begin;
    const std::string fresh = read("new.exr");
    remove("new.exr");
    std::mt19937 random(5);
    std::uniform_real_distribution<double> moment(0, whole.count());
    int killed = 0;
    for (int i = 0; i < 100; ++i) {
        write("x.exr", old);
        const pid_t child = start("384", "4", "x.exr");
        std::this_thread::sleep_for(std::chrono::duration<double>(moment(random)));
        ::kill(child, i % 2 ? SIGINT : SIGKILL);
        const int code = wait(child);
        killed += code != 0;
        EXPECT_THAT(code, testing::AnyOf(0, 1, -SIGINT, -SIGKILL));
        // Between the last byte and the exit code a signal may come too.
        const std::string seen = read("x.exr");
        EXPECT_TRUE(seen == fresh || (code != 0 && seen == old))
            << "half a file, or an old one, with exit code " << code;
        EXPECT_THAT(names(), testing::ElementsAre("x.exr")) << "debris";
    }
    EXPECT_GT(killed, 0);
    row.naive("a file written in place is truncated; a temporary file is left behind");
    row.ours("the old file or the new one, and nothing else in the folder");
}

TEST_F(Machine, TwoWriters)
{
    HardCase row("Four processes writing one file at the same time");
    std::string either[2];
    const char* const samples[] = { "4", "5" };
    for (int i = 0; i < 2; ++i) {
        ASSERT_EQ(wait(start("128", samples[i], "only.exr")), 0);
        either[i] = read("only.exr");
        remove("only.exr");
    }
    for (int round = 0; round < 8; ++round) {
        pid_t running[4];
        for (int i = 0; i < 4; ++i)
            running[i] = start("128", samples[i % 2], "x.exr");
        for (const pid_t child : running)
            EXPECT_EQ(wait(child), 0);
        const std::string seen = read("x.exr");
        EXPECT_TRUE(seen == either[0] || seen == either[1]) << "neither's file";
        EXPECT_THAT(names(), testing::ElementsAre("x.exr")) << "debris";
    }
    row.naive("interleaved bytes");
    row.ours("the whole file of one of them");
}
