// SPDX-License-Identifier: Apache-2.0
/// How much memory is left, so that jobs that cannot fit fail up front. Linux overcommits: without this check the OOM
/// killer ends the process later.
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <string>

namespace vmlight {

/// Upper bound, in bytes, on what this process can still allocate: the least of what is left on the machine, in each of
/// its control groups (cgroup v1 or v2) and by its own limits (RLIMIT_AS, RLIMIT_DATA). The page cache counts as free,
/// and so does free swap, up to the swap limit of the group (v2). The largest int64_t if nothing is known.
///
/// @param root     prefix of /proc and /sys, for tests
int64_t available_memory(const std::string& root = "");

/// Give memory that was freed back to the system, as far as the allocator allows, which otherwise keeps some for later.
/// Takes milliseconds. Nothing but with glibc.
void release_freed_memory();

/// "" if an image of `spec` fits in memory as float, with `more` bytes besides it, else the reason why not. Counts no
/// more, so that it never refuses a job that could have run.
std::string memory_shortage(const OIIO::ImageSpec& spec, double more = 0);

} // namespace vmlight
