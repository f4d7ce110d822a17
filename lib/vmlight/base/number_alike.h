// SPDX-License-Identifier: Apache-2.0
/// Which of many elements have equal keys.
#pragma once

#include <vmlight/base/parallel_blocks.h>

#include <OpenImageIO/hash.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

namespace vmlight {

/// Sorts elements by a hash of their keys into buckets that fit a processor's cache, and looks for equal ones in each:
/// one table of all would miss the cache at every step.
class AlikeBuckets
{
public:
    struct Entry
    {
        uint32_t hash, element;
    };

    /// @param count    of elements, below 2^32 - 1
    /// @param key_of   the key of an element; called from several threads, twice for each element and again for those
    ///                 that it may equal. Keys are compared bytewise
    /// @returns for each element the first one with an equal key
    template <class KeyOf> static std::vector<uint32_t> first_alike(size_t count, const KeyOf& key_of)
    {
        const auto hash_of = [&](size_t element) {
            const auto key = key_of(element);
            return uint64_t(OIIO::farmhash::Fingerprint64(reinterpret_cast<const char*>(&key), sizeof(key)));
        };
        const AlikeBuckets buckets(count, hash_of);
        std::vector<uint32_t> first(count);
        std::vector<std::vector<uint32_t>> slots(size_t(worker_count(0)));
        parallel_items(int64_t(buckets.m_begin.size()) - 1, 0, [&](int64_t bucket, int worker) {
            const Entry* begin = buckets.m_entries.get() + buckets.m_begin[size_t(bucket)];
            const Entry* end = buckets.m_entries.get() + buckets.m_begin[size_t(bucket) + 1];
            find_in_bucket(first, begin, end, key_of, slots[size_t(worker)]);
        });
        return first;
    }

private:
    static constexpr uint32_t kNone = ~0u;

    template <class HashOf> AlikeBuckets(size_t count, const HashOf& hash_of)
    {
        constexpr size_t kEntriesOfBucket = size_t(1) << 15; // with its table half a megabyte
        unsigned bits = 0;
        while (bits < 10 && count >> bits > kEntriesOfBucket)
            ++bits;
        const size_t buckets = size_t(1) << bits, blocks = block_count(count);
        const auto bucket_of = [bits](uint64_t hash) { return bits ? size_t(hash >> (64 - bits)) : 0; };
        std::vector<size_t> next(buckets * blocks); // of a block, in a bucket
        parallel_blocks(count, [&](size_t begin, size_t end, size_t block) {
            for (size_t i = begin; i < end; ++i)
                ++next[block * buckets + bucket_of(hash_of(i))];
        });
        size_t sum = 0;
        for (size_t bucket = 0; bucket < buckets; ++bucket) {
            m_begin.push_back(sum);
            for (size_t block = 0; block < blocks; ++block)
                sum += std::exchange(next[block * buckets + bucket], sum);
        }
        m_begin.push_back(sum);
        m_entries.reset(new Entry[count]); // not cleared: many threads touch it first
        parallel_blocks(count, [&](size_t begin, size_t end, size_t block) {
            for (size_t i = begin; i < end; ++i) {
                const uint64_t hash = hash_of(i);
                m_entries[next[block * buckets + bucket_of(hash)]++] = { uint32_t(hash), uint32_t(i) };
            }
        });
    }

    // Elements ascend within a bucket. The low bits of the hash choose the slot.
    template <class KeyOf>
    static void find_in_bucket(std::vector<uint32_t>& first, const Entry* begin, const Entry* end, const KeyOf& key_of,
                               std::vector<uint32_t>& slots)
    {
        size_t mask = 15;
        while (mask < 2 * size_t(end - begin))
            mask = 2 * mask + 1;
        slots.assign(mask + 1, kNone); // positions in the bucket
        const auto is_equal = [&](const Entry& a, const Entry& b) {
            if (a.hash != b.hash)
                return false;
            const auto key = key_of(a.element), other = key_of(b.element);
            return std::memcmp(&other, &key, sizeof(key)) == 0;
        };
        for (const Entry* entry = begin; entry < end; ++entry) {
            size_t slot = entry->hash & mask;
            while (slots[slot] != kNone && !is_equal(begin[slots[slot]], *entry))
                slot = (slot + 1) & mask;
            if (slots[slot] == kNone)
                slots[slot] = uint32_t(entry - begin);
            first[entry->element] = begin[slots[slot]].element;
        }
    }

    std::unique_ptr<Entry[]> m_entries;
    std::vector<size_t> m_begin; // of each bucket, and the end
};

/// Numbers for `count` elements, those with equal keys alike: 0, 1, 2, ... in the order in which they first occur.
/// @param key_of   see AlikeBuckets
/// @param first    set to the first element of each number
template <class KeyOf>
std::vector<uint32_t> number_alike(size_t count, const KeyOf& key_of, std::vector<uint32_t>& first)
{
    std::vector<uint32_t> numbers = AlikeBuckets::first_alike(count, key_of);
    first.clear();
    first.reserve(count);
    for (size_t i = 0; i < count; ++i) {
        if (numbers[i] == i) {
            numbers[i] = uint32_t(first.size());
            first.push_back(uint32_t(i));
        } else {
            numbers[i] = numbers[numbers[i]];
        }
    }
    return numbers;
}

} // namespace vmlight
