// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/interrupt.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace vmlight {
namespace {

std::atomic<bool> s_interrupted { false };
std::atomic<int> s_debris { 0 }; // files that an exit would leave behind
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);
char s_farewell[64]; // what to say from within a signal handler, which may format nothing
int s_exit_code = 1;
constexpr int kInterrupts[] = { SIGINT, SIGTERM, SIGHUP };

// Reading a mesh or building its tree does not look at s_interrupted for seconds. While no output is being written
// there is nothing to tidy up, and no need to wait for them.
void interrupt(int)
{
    if (!s_interrupted.exchange(true) && s_debris > 0)
        return; // the second time the user means it
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, s_farewell, std::strlen(s_farewell));
    ::_exit(s_exit_code);
}

} // namespace

void catch_interrupts(const std::string& name, int exit_code)
{
    s_exit_code = exit_code;
    std::snprintf(s_farewell, sizeof(s_farewell), "%s%s ERROR: interrupted\n", ::isatty(STDERR_FILENO) ? "\n" : "",
                  name.c_str());
    // A signal that the parent ignores (nohup, a shell's background) stays ignored.
    for (int number : kInterrupts)
        if (std::signal(number, interrupt) == SIG_IGN)
            std::signal(number, SIG_IGN);
}

void ignore_interrupts()
{
    for (int number : kInterrupts)
        std::signal(number, SIG_IGN);
}

void settle_streams()
{
    for (int number : { SIGPIPE, SIGXFSZ })
        std::signal(number, SIG_IGN);
    // Each gets the lowest number that is free.
    int stream;
    while ((stream = ::open("/dev/null", O_RDWR)) >= 0 && stream <= STDERR_FILENO) { }
    ::close(stream);
}

bool interrupted()
{
    return s_interrupted;
}

WhileWriting::WhileWriting()
{
    ++s_debris;
}

WhileWriting::~WhileWriting()
{
    --s_debris;
}

} // namespace vmlight
