// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/process_exit.h>

#include <atomic>

namespace vmlight {
namespace {

std::atomic<bool> s_is_exiting { false }; // has no destructor

// Destroyed before the libraries that this one is linked with are finalised.
struct Sentinel
{
    ~Sentinel() { s_is_exiting = true; }
} s_sentinel;

} // namespace

bool is_process_exiting()
{
    return s_is_exiting;
}

} // namespace vmlight
