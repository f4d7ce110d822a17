// SPDX-License-Identifier: Apache-2.0
#include "failing_calls.h"

#include <atomic>
#include <cerrno>
#include <cstdarg>

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace vmlight {
namespace {

std::atomic<int> s_kind { -1 }, s_first { 0 }, s_count { 0 };
std::atomic<bool> s_all_after { false }, s_no_unnamed { false };

bool fails(FailingCalls::Kind kind)
{
    if (s_kind != kind)
        return false;
    const int number = ++s_count, first = s_first;
    return first > 0 && (s_all_after ? number >= first : number == first);
}

// A thread that is counted while it runs.
struct CountedThread
{
    void* (*run)(void*);
    void* data;

    static void* run_counted(void* thread)
    {
        const CountedThread counted = *static_cast<CountedThread*>(thread);
        delete static_cast<CountedThread*>(thread);
        void* const result = counted.run(counted.data);
        --s_count;
        return result;
    }
};

// Whether this call of a file fails, with its error in `errno`.
bool file_fails()
{
    const bool does = fails(FailingCalls::Files);
    if (does)
        errno = EIO;
    return does;
}

} // namespace

FailingCalls::FailingCalls(Kind kind, int first, bool all_after)
{
    s_first = first;
    s_all_after = all_after;
    s_count = 0;
    s_kind = kind;
}

FailingCalls::~FailingCalls()
{
    s_kind = -1;
}

int FailingCalls::count() const
{
    return s_count;
}

NoUnnamedFiles::NoUnnamedFiles()
{
    s_no_unnamed = true;
}

NoUnnamedFiles::~NoUnnamedFiles()
{
    s_no_unnamed = false;
}

} // namespace vmlight

using namespace vmlight;

extern "C"
{

    ssize_t pwrite(int file, const void* bytes, size_t size, off_t offset)
    {
        if (file_fails())
            return -1;
        if (size > 1 && fails(FailingCalls::ShortWrites))
            size = 1;
        return ::syscall(SYS_pwrite64, file, bytes, size, offset);
    }

    int fsync(int file)
    {
        return file_fails() ? -1 : int(::syscall(SYS_fsync, file));
    }

    int linkat(int old_folder, const char* old_name, int folder, const char* name, int flags) noexcept
    {
        return file_fails() ? -1 : int(::syscall(SYS_linkat, old_folder, old_name, folder, name, flags));
    }

    int renameat(int old_folder, const char* old_name, int folder, const char* name) noexcept
    {
        return file_fails() ? -1 : int(::syscall(SYS_renameat2, old_folder, old_name, folder, name, 0));
    }

    int openat(int folder, const char* name, int flags, ...)
    {
        const bool unnamed = (flags & O_TMPFILE) == O_TMPFILE, is_new = unnamed || (flags & O_CREAT);
        mode_t mode = 0;
        if (is_new) {
            va_list arguments;
            va_start(arguments, flags);
            mode = va_arg(arguments, mode_t);
            va_end(arguments);
        }
        if (unnamed && s_no_unnamed) {
            errno = EOPNOTSUPP;
            return -1;
        }
        return is_new && file_fails() ? -1 : int(::syscall(SYS_openat, folder, name, flags, mode));
    }

#ifndef VMLIGHT_SANITIZED // which must see all threads
    int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* data)
    {
        using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
        static const Create create = reinterpret_cast<Create>(::dlsym(RTLD_NEXT, "pthread_create"));
        if (s_kind != FailingCalls::Threads)
            return create(thread, attributes, run, data);
        if (++s_count >= s_first) {
            --s_count;
            return EAGAIN;
        }
        auto* counted = new CountedThread { run, data };
        const int fault = create(thread, attributes, CountedThread::run_counted, counted);
        if (fault) {
            --s_count;
            delete counted;
        }
        return fault;
    }
#endif
}
