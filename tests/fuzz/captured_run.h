// SPDX-License-Identifier: Apache-2.0
/// An executable's main, run in this process.
#pragma once

#include <sanitizer/common_interface_defs.h>

#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <unistd.h>
#include <vector>

namespace vmlight::fuzz {

using Main = int (*)(int argc, const char** argv);

/// What is written to a file descriptor while this lives.
class Captured
{
public:
    Captured(int descriptor, std::FILE* stream)
        : m_descriptor(descriptor)
        , m_stream(stream)
        , m_saved(::dup(descriptor))
        , m_memory(::memfd_create("captured", MFD_CLOEXEC))
    {
        if (descriptor == STDERR_FILENO) // where sanitizers are heard
            __sanitizer_set_report_fd(reinterpret_cast<void*>(intptr_t(m_saved)));
        ::dup2(m_memory, descriptor);
    }
    Captured(const Captured&) = delete;
    ~Captured()
    {
        if (m_descriptor == STDERR_FILENO)
            __sanitizer_set_report_fd(reinterpret_cast<void*>(intptr_t(STDERR_FILENO)));
        std::fflush(m_stream);
        ::dup2(m_saved, m_descriptor);
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
    int m_descriptor;
    std::FILE* m_stream;
    int m_saved, m_memory;
};

/// Being in a folder that has no files, nor can have any, while this lives.
class Nowhere
{
public:
    Nowhere()
        : m_before(::open(".", O_RDONLY | O_DIRECTORY | O_CLOEXEC))
    {
        std::string folder = "/tmp/nowhere.XXXXXX";
        if (!::mkdtemp(folder.data()) || ::chdir(folder.c_str()) != 0 || ::rmdir(folder.c_str()) != 0)
            std::abort();
    }
    Nowhere(const Nowhere&) = delete;
    ~Nowhere()
    {
        if (::fchdir(m_before) != 0)
            std::abort();
        ::close(m_before);
    }

private:
    int m_before;
};

struct CapturedRun
{
    int code;
    std::string out, err;

    CapturedRun(Main main, const std::vector<std::string>& words)
    {
        std::vector<const char*> pointers;
        for (const std::string& word : words)
            pointers.push_back(word.c_str());
        pointers.push_back(nullptr);
        const Nowhere nowhere;
        const Captured stdout_text(STDOUT_FILENO, stdout), stderr_text(STDERR_FILENO, stderr);
        code = main(int(words.size()), pointers.data());
        out = stdout_text.text();
        err = stderr_text.text();
    }
};

} // namespace vmlight::fuzz
