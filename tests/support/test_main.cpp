// SPDX-License-Identifier: Apache-2.0
// The main of the test binaries. Hundreds of tests share a process, so the limit of each is kept here: a test may take
// VMLIGHT_TEST_LIMIT (60) seconds of processor time. Unlike the clock's, these are the same on a busy machine. A test
// that waits for something that never comes uses none, so ten times the limit by the clock ends it too.
#include "captured.h"
#include "watchdog.h"

#include <gtest/gtest.h>

#include <OpenImageIO/imageio.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

namespace vmlight {
namespace {

int s_limit = 60; // seconds of processor time
bool s_finished = false;
int s_stderr = STDERR_FILENO; // where it leads to before tests redirect it
char s_test[512], s_case[512]; // a signal handler may format nothing

void write_text(const char* text)
{
    [[maybe_unused]] const ssize_t written = ::write(s_stderr, text, std::strlen(text));
}

void write_name(const char* what)
{
    write_text(what);
    write_text(s_test);
    if (s_case[0]) {
        write_text(": ");
        write_text(s_case);
    }
    write_text("\n");
}

void name_test(int number)
{
    const bool hangs = number == SIGPROF || number == SIGALRM;
    write_name(hangs ? "\nTEST TOOK TOO LONG: " : "\nTEST CRASHED: ");
    std::signal(SIGABRT, SIG_DFL);
    if (hangs)
        std::abort();
    std::signal(number, SIG_DFL);
    std::raise(number);
}

void set_limit(int seconds)
{
    const itimerval processor { {}, { seconds, 0 } };
    ::setitimer(ITIMER_PROF, &processor, nullptr);
    ::alarm(unsigned(10 * seconds));
}

void copy_text(char (&dst)[512], const std::string& text)
{
    dst[text.copy(dst, sizeof(dst) - 1)] = '\0';
}

class Watchdog : public testing::EmptyTestEventListener
{
    void OnTestStart(const testing::TestInfo& test) override
    {
        copy_text(s_test, std::string(test.test_suite_name()) + "." + test.name());
        s_case[0] = '\0';
        set_limit(s_limit);
    }
    void OnTestEnd(const testing::TestInfo&) override { set_limit(0); }
};

} // namespace

void set_current_case(const std::string& text)
{
    copy_text(s_case, text);
}

void restart_watchdog()
{
    set_limit(s_limit);
}

void extend_watchdog(int factor)
{
    set_limit(factor * s_limit);
}

} // namespace vmlight

int main(int argc, char** argv)
{
    using namespace vmlight;
    testing::InitGoogleTest(&argc, argv);
    testing::UnitTest::GetInstance()->listeners().Append(new Watchdog);
    for (int number : { SIGPROF, SIGALRM })
        std::signal(number, name_test);
#ifdef VMLIGHT_ADDRESS_SANITIZER // which has handlers of its own, and a report to add to
    __sanitizer_set_death_callback([] { write_name("\nTEST CRASHED: "); });
#else
    for (int number : { SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL })
        std::signal(number, name_test);
#endif
    s_stderr = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
    if (const char* limit = std::getenv("VMLIGHT_TEST_LIMIT"))
        s_limit = std::max(1, std::atoi(limit));
    // A library that calls exit() would skip the remaining tests without a trace.
    std::atexit([] {
        if (!s_finished)
            ::_exit(1);
    });
    ::unsetenv("OCIO");
    const int result = RUN_ALL_TESTS();
    s_finished = true;
    return result;
}
