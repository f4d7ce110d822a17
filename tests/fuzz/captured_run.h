// SPDX-License-Identifier: Apache-2.0
/// An executable's main, run in this process.
#pragma once

#include "captured.h"
#include "mains.h"

#include <cstdlib>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace vmlight::fuzz {

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
