// SPDX-License-Identifier: Apache-2.0
// Hard machines: runs that are killed, and several that write one target. Each run is a fork of this process, in which
// all libraries are loaded: a kill then falls on the run's own work, not on the loader's. No test here may run anything
// in this process itself, since a fork has none of the threads that were started before it. (What takes another kind of
// process is in machine_test.py.)
#include "command_test.h"
#include "failing_calls.h"
#include "hard_case.h"
#include "mains.h"

#include <chrono>
#include <optional>
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
        return start(
            makevismap_main,
            { "makevismap", kSpot, "--resolution", resolution, "--samples", samples, "--quiet", "-o", output });
    }
    /// Starts a main with these words; what it says goes to the file `said`. No more than `threads` threads run at once
    /// besides the first; negative: as many as it likes.
    static pid_t start(Main main, const std::vector<std::string>& words, const char* said = "/dev/null",
                       int threads = -1)
    {
        const pid_t child = ::fork();
        if (child != 0)
            return child;
        const int file = ::open(said, O_WRONLY | O_CREAT | O_TRUNC, 0600);
        ::dup2(file, STDOUT_FILENO);
        ::dup2(file, STDERR_FILENO);
        std::vector<const char*> pointers;
        for (const std::string& word : words)
            pointers.push_back(word.c_str());
        pointers.push_back(nullptr);
        ::alarm(100); // ends one that waits for a thread that did not start
        std::optional<FailingCalls> failing;
        if (threads >= 0)
            failing.emplace(FailingCalls::Threads, threads + 1, true);
        ::_exit(main(int(words.size()), pointers.data()));
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
    ASSERT_EQ(wait(start("192", "4", "new.exr")), 0);
    const std::chrono::duration<double> whole = Clock::now() - begin;
    const std::string fresh = read("new.exr");
    remove("new.exr");
    std::mt19937 random(5);
    std::uniform_real_distribution<double> moment(0, whole.count());
    int killed = 0;
    for (int i = 0; i < 100; ++i) {
        write("x.exr", old);
        const pid_t child = start("192", "4", "x.exr");
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

TEST_F(Machine, ThreadsThatDoNotStart)
{
#ifdef VMLIGHT_SANITIZED
    GTEST_SKIP() << "sanitizers start threads themselves";
#endif
    HardCase row("No more threads can be started (`ulimit -u`), from the first or any later one on");
    struct Run
    {
        Main main;
        std::vector<std::string> words;
    };
    const std::vector<Run> runs {
        { makevismap_main, { "makevismap", kSpot, "--resolution", "16", "--samples", "4", "-o" } },
        { makecfem_main, { "makecfem", kSky, "--resolution", "16", "--stack", "-o" } },
        { makelightmap_main, { "makelightmap", "vm.exr", "cfem.exr", "-o" } },
    };
    for (const Run& run : runs)
        for (const std::string number : { "2", "5" }) {
            const auto run_with = [&](const std::string& output, int threads) {
                std::vector<std::string> words = run.words;
                words.insert(words.end(), { output, "--threads", number });
                return wait(start(run.main, words, "said", threads));
            };
            ASSERT_EQ(run_with("new.exr", -1), 0);
            const std::string fresh = read("new.exr");
            for (const int threads : { 0, 1, 2, 3, 5, 8, 11, 14, 17, 40 }) {
                write("x.exr", "the old picture");
                const int code = run_with("x.exr", threads);
                const std::string said = read("said"), seen = read("x.exr");
                EXPECT_THAT(code, testing::AnyOf(0, 1)) << run.words[0] << ", " << threads << " threads: " << said;
                EXPECT_TRUE(seen == (code == 0 ? fresh : "the old picture")) << threads;
                EXPECT_TRUE(code == 0 || said.find(run.words[0] + " ERROR: ") != std::string::npos) << said;
                remove("x.exr");
            }
            if (run.main != makelightmap_main)
                write(run.main == makevismap_main ? "vm.exr" : "cfem.exr", fresh);
            remove("new.exr");
            remove("said");
        }
    EXPECT_THAT(names(), testing::ElementsAre("cfem.exr", "vm.exr")) << "debris";
    row.naive("std::system_error, or an abort inside a library");
    row.ours("the same image, or exit code 1 with the reason; never half a file");
}
