// SPDX-License-Identifier: Apache-2.0
/// System calls that fail when a test wants it: those by which a file is written and put in its place, and those by
/// which threads are started. failing_calls.cpp defines them in the test's program, so that all libraries use them.
#pragma once

namespace vmlight {

/// While one of these exists, one call of its kind fails, or all from it on; of Threads, those that are too many.
class FailingCalls
{
public:
    enum Kind
    {
        /// pwrite, fsync, linkat, renameat, and openat of a new file: fail with EIO.
        Files,
        /// pwrite alone: it writes one byte of several. No failure.
        ShortWrites,
        /// pthread_create: fails with EAGAIN while first - 1 threads run that were started since.
        Threads
    };
    /// @param first      the first call that fails, counted from 1; 0: none
    /// @param all_after  whether the calls after it fail too
    FailingCalls(Kind kind, int first, bool all_after = false);
    FailingCalls(const FailingCalls&) = delete;
    ~FailingCalls();

    /// Calls of the kind since it was made.
    int count() const;
};

/// While one of these exists, no file can be opened without a name (O_TMPFILE), as on NFS.
class NoUnnamedFiles
{
public:
    NoUnnamedFiles();
    NoUnnamedFiles(const NoUnnamedFiles&) = delete;
    ~NoUnnamedFiles();
};

} // namespace vmlight
