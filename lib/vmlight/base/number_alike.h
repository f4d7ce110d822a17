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

/// Elements sorted by a hash of their keys into buckets that fit a processor's cache with a table of their own. One
/// table of all would miss the cache at every look.
class HashBuckets
{
public:
    struct Entry
    {
        uint32_t hash, element;
    };

    /// @param hash_of  of an element; called twice for each, from several threads
    template <class HashOf> HashBuckets(size_t count, const HashOf& hash_of)
    {
        constexpr size_t kEntriesOfBucket = size_t(1) << 15; // with their table half a megabyte
        constexpr unsigned kMostBits = 10; // of the hash: each block of elements counts all buckets
        unsigned bits = 0;
        while (bits < kMostBits && count >> bits > kEntriesOfBucket)
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

    size_t count() const { return m_begin.size() - 1; }
    /// Elements ascend within a bucket.
    const Entry* begin(size_t bucket) const { return m_entries.get() + m_begin[bucket]; }
    const Entry* end(size_t bucket) const { return m_entries.get() + m_begin[bucket + 1]; }

private:
    std::unique_ptr<Entry[]> m_entries;
    std::vector<size_t> m_begin; // of each bucket, and the end
};

/// The first element with an equal key, of each. Works in parallel; the result does not depend on the threads.
/// @param count    of elements, below 2^32 - 1
/// @param key_of   the key of an element, compared bytewise; called from several threads, twice for each element and
///                 again for those that it may equal
template <class KeyOf> std::vector<uint32_t> first_alike(size_t count, const KeyOf& key_of)
{
    constexpr uint32_t kNone = ~0u;
    using Entry = HashBuckets::Entry;
    const HashBuckets buckets(count, [&](size_t element) {
        const auto key = key_of(element);
        return uint64_t(OIIO::farmhash::Fingerprint64(reinterpret_cast<const char*>(&key), sizeof(key)));
    });
    const auto is_equal = [&](const Entry& a, const Entry& b) {
        if (a.hash != b.hash)
            return false;
        const auto key = key_of(a.element), other = key_of(b.element);
        return std::memcmp(&other, &key, sizeof(key)) == 0;
    };
    std::vector<uint32_t> first(count);
    std::vector<std::vector<uint32_t>> tables(size_t(worker_count(0))); // positions in the bucket
    parallel_items(int64_t(buckets.count()), 0, [&](int64_t bucket, int worker) {
        const Entry *const begin = buckets.begin(size_t(bucket)), *const end = buckets.end(size_t(bucket));
        std::vector<uint32_t>& table = tables[size_t(worker)];
        size_t mask = 15;
        while (mask < 2 * size_t(end - begin))
            mask = 2 * mask + 1;
        table.assign(mask + 1, kNone);
        for (const Entry* entry = begin; entry < end; ++entry) {
            size_t slot = entry->hash & mask;
            while (table[slot] != kNone && !is_equal(begin[table[slot]], *entry))
                slot = (slot + 1) & mask;
            if (table[slot] == kNone)
                table[slot] = uint32_t(entry - begin);
            first[entry->element] = begin[table[slot]].element;
        }
    });
    return first;
}

/// Numbers for `count` elements, those with equal keys alike: 0, 1, 2, ... in the order in which they first occur.
/// @param key_of   see first_alike()
/// @param first    set to the first element of each number
template <class KeyOf>
std::vector<uint32_t> number_alike(size_t count, const KeyOf& key_of, std::vector<uint32_t>& first)
{
    std::vector<uint32_t> numbers = first_alike(count, key_of);
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
