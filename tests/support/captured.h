// SPDX-License-Identifier: Apache-2.0
/// What a main prints, when it runs in this process.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define VMLIGHT_ADDRESS_SANITIZER
#endif
#endif
#ifdef VMLIGHT_ADDRESS_SANITIZER
#include <sanitizer/common_interface_defs.h>
#endif

namespace vmlight {

/// Collects what is written to a file descriptor while this exists. Reports of sanitizers still reach stderr.
class Captured
{
public:
    /// @param descriptor  STDOUT_FILENO or STDERR_FILENO
    /// @param stream      its stream, flushed before and after
    Captured(int descriptor, std::FILE* stream)
        : m_descriptor(descriptor)
        , m_stream(stream)
        , m_saved(::fcntl(descriptor, F_DUPFD_CLOEXEC, 3))
        , m_memory(::memfd_create("captured", MFD_CLOEXEC))
    {
        report_to(m_saved);
        std::fflush(m_stream);
        ::dup2(m_memory, descriptor);
    }
    Captured(const Captured&) = delete;
    Captured& operator=(const Captured&) = delete;
    ~Captured()
    {
        std::fflush(m_stream);
        ::dup2(m_saved, m_descriptor);
        report_to(m_descriptor);
        ::close(m_saved);
        ::close(m_memory);
    }

    std::string text() const
    {
        std::fflush(m_stream);
        const off_t size = ::lseek(m_memory, 0, SEEK_END);
        std::string text(size_t(size), '\0');
        if (::pread(m_memory, text.data(), text.size(), 0) != ssize_t(text.size()))
            std::abort();
        return text;
    }

private:
    void report_to([[maybe_unused]] int descriptor) const
    {
#ifdef VMLIGHT_ADDRESS_SANITIZER
        if (m_descriptor == STDERR_FILENO)
            __sanitizer_set_report_fd(reinterpret_cast<void*>(intptr_t(descriptor)));
#endif
    }

    int m_descriptor;
    std::FILE* m_stream;
    int m_saved, m_memory;
};

} // namespace vmlight
