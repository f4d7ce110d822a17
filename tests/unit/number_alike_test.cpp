// SPDX-License-Identifier: Apache-2.0
#include "thread_count.h"

#include <vmlight/base/disjoint_sets.h>
#include <vmlight/base/number_alike.h>

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <numeric>
#include <random>

using namespace vmlight;

namespace {

constexpr size_t kMany = 2 * kElementsOfBlock + 3; // several blocks, several buckets

std::vector<uint64_t> drawn_keys(size_t count, uint64_t most)
{
    std::mt19937_64 random(1);
    std::vector<uint64_t> keys(count);
    for (uint64_t& key : keys)
        key = random() % most << 40 | random() % 2;
    return keys;
}

} // namespace

TEST(NumberAlike, ElementsWithEqualKeysInTheOrderOfTheFirst)
{
    const std::vector<uint64_t> keys { 7, 3, 7, 9, 3, 7, 0 };
    std::vector<uint32_t> first { 5 };
    const auto key_of = [&](size_t i) { return keys[i]; };
    EXPECT_EQ(number_alike(keys.size(), key_of, first), (std::vector<uint32_t> { 0, 1, 0, 2, 1, 0, 3 }));
    EXPECT_EQ(first, (std::vector<uint32_t> { 0, 1, 3, 6 }));
    EXPECT_TRUE(number_alike(0, key_of, first).empty());
    EXPECT_TRUE(first.empty());
}

TEST(NumberAlike, ManyElementsAsAMapDoes)
{
    for (const int threads : { 1, 3 }) {
        const ThreadCount scope(threads);
        for (const uint64_t most : { uint64_t(1), uint64_t(1000), uint64_t(1) << 20 }) {
            const std::vector<uint64_t> keys = drawn_keys(kMany, most);
            std::map<uint64_t, uint32_t> known;
            std::vector<uint32_t> expected, first, expected_first;
            for (uint32_t i = 0; i < keys.size(); ++i) {
                const auto [place, is_new] = known.emplace(keys[i], uint32_t(known.size()));
                expected.push_back(place->second);
                if (is_new)
                    expected_first.push_back(i);
            }
            EXPECT_EQ(number_alike(
                          keys.size(), [&](size_t i) { return keys[i]; }, first),
                      expected);
            EXPECT_EQ(first, expected_first);
        }
    }
}

TEST(NumberAlike, KeysDecideWhereHashesAreEqual)
{
    std::map<uint32_t, uint64_t> known;
    int pairs = 0;
    for (uint64_t key = 0; key < 400000; ++key) {
        const auto hash = uint32_t(OIIO::farmhash::Fingerprint64(reinterpret_cast<const char*>(&key), sizeof(key)));
        const auto [place, is_new] = known.emplace(hash, key);
        if (is_new)
            continue;
        const std::array<uint64_t, 3> keys { place->second, key, place->second };
        std::vector<uint32_t> first;
        EXPECT_EQ(number_alike(
                      keys.size(), [&](size_t i) { return keys[i]; }, first),
                  (std::vector<uint32_t> { 0, 1, 0 }));
        ++pairs;
    }
    EXPECT_GT(pairs, 0) << "of 400,000, some 19 share the half of the hash that is kept";
}

TEST(DisjointSets, AreKnownByTheirLeastHoweverTheyAreJoined)
{
    std::vector<std::pair<uint32_t, uint32_t>> pairs;
    std::mt19937 random(2);
    for (size_t i = 0; i < kMany / 2; ++i)
        pairs.emplace_back(random() % kMany, random() % kMany);
    // Least of each set, by passing it along pairs until nothing changes.
    std::vector<uint32_t> expected(kMany);
    std::iota(expected.begin(), expected.end(), 0u);
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [a, b] : pairs)
            if (expected[a] != expected[b]) {
                expected[a] = expected[b] = std::min(expected[a], expected[b]);
                changed = true;
            }
    }
    for (const int threads : { 1, 4 }) {
        const ThreadCount scope(threads);
        DisjointSets sets(kMany);
        parallel_blocks(pairs.size(), [&](size_t begin, size_t end, size_t) {
            for (size_t i = begin; i < end; ++i)
                sets.join(pairs[i].first, pairs[i].second);
        });
        for (uint32_t i = 0; i < kMany; ++i)
            ASSERT_EQ(sets.find(i), expected[i]) << i << ", " << threads << " threads";
        std::shuffle(pairs.begin(), pairs.end(), random);
    }
}
