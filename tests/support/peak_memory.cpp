// SPDX-License-Identifier: Apache-2.0
#include "peak_memory.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace vmlight {
namespace {

std::atomic<int64_t> s_held { 0 }, s_peak { 0 };

[[maybe_unused]] void* counted(void* memory)
{
    const auto size = int64_t(::malloc_usable_size(memory));
    const int64_t held = s_held.fetch_add(size) + size;
    for (int64_t peak = s_peak; held > peak && !s_peak.compare_exchange_weak(peak, held);) { }
    return memory;
}

[[maybe_unused]] void give_back(void* memory)
{
    s_held -= int64_t(::malloc_usable_size(memory));
    std::free(memory);
}

} // namespace

PeakMemory::PeakMemory()
    : m_before(s_held)
{
    s_peak = m_before;
}

int64_t PeakMemory::bytes() const
{
    return s_peak - m_before;
}

} // namespace vmlight

#ifndef VMLIGHT_SANITIZED
using namespace vmlight;

// The other forms of both call these.
void* operator new(size_t size)
{
    if (void* memory = std::malloc(size ? size : 1))
        return counted(memory);
    throw std::bad_alloc();
}

void* operator new(size_t size, std::align_val_t alignment)
{
    void* memory = nullptr;
    if (::posix_memalign(&memory, size_t(alignment), size ? size : 1) == 0)
        return counted(memory);
    throw std::bad_alloc();
}

void operator delete(void* memory) noexcept
{
    give_back(memory);
}

void operator delete(void* memory, size_t) noexcept
{
    give_back(memory);
}

void operator delete(void* memory, std::align_val_t) noexcept
{
    give_back(memory);
}

void operator delete(void* memory, size_t, std::align_val_t) noexcept
{
    give_back(memory);
}
#endif
