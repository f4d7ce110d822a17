// SPDX-License-Identifier: Apache-2.0
#include "allocations.h"

#include <vmlight/base/sanitizers.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

constexpr size_t kLarge = 4096;
std::atomic<bool> s_counts { false };
std::atomic<int64_t> s_large { 0 };

} // namespace

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

void* operator new(size_t size)
{
    if (size >= kLarge && s_counts.load(std::memory_order_relaxed))
        ++s_large;
    if (void* memory = std::malloc(size ? size : 1))
        return memory;
    throw std::bad_alloc();
}

void operator delete(void* memory) noexcept
{
    std::free(memory);
}

void operator delete(void* memory, size_t) noexcept
{
    std::free(memory);
}

#endif

namespace vmlight {

LargeAllocations::LargeAllocations()
{
    s_large = 0;
    s_counts = true;
}

LargeAllocations::~LargeAllocations()
{
    s_counts = false;
}

int64_t LargeAllocations::count() const
{
    return s_large;
}

} // namespace vmlight
