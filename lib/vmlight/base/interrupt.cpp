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
std::atomic<int> s_deferrals { 0 };
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);
char s_message[64]; // a signal handler must not format text
int s_exit_code = 1;
constexpr int kInterrupts[] = { SIGINT, SIGTERM, SIGHUP };

// Reading a mesh or building its BVH does not check s_interrupted for seconds. While no output is being written there
// is nothing to clean up, and no need to wait for them.
void interrupt(int)
{
    if (!s_interrupted.exchange(true) && s_deferrals > 0)
        return; // the second signal exits
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, s_message, std::strlen(s_message));
    ::_exit(s_exit_code);
}

} // namespace

void catch_interrupts(const std::string& name, int exit_code)
{
    s_exit_code = exit_code;
    std::snprintf(s_message, sizeof(s_message), "%s%s ERROR: interrupted\n", ::isatty(STDERR_FILENO) ? "\n" : "",
                  name.c_str());
    // A signal that the parent process ignores (nohup, background jobs of a shell) stays ignored.
    for (int number : kInterrupts)
        if (std::signal(number, interrupt) == SIG_IGN)
            std::signal(number, SIG_IGN);
}

void ignore_interrupts()
{
    for (int number : kInterrupts)
        std::signal(number, SIG_IGN);
}

void prepare_streams()
{
    for (int number : { SIGPIPE, SIGXFSZ })
        std::signal(number, SIG_IGN);
    // open() returns the lowest free descriptor.
    int stream;
    while ((stream = ::open("/dev/null", O_RDWR)) >= 0 && stream <= STDERR_FILENO) { }
    ::close(stream);
}

bool interrupted()
{
    return s_interrupted;
}

DeferInterrupts::DeferInterrupts()
{
    ++s_deferrals;
}

DeferInterrupts::~DeferInterrupts()
{
    --s_deferrals;
}

} // namespace vmlight
