// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/triangle_indices.h>

#include <gtest/gtest.h>

#include <random>

using namespace vmlight;

TEST(TriangleIndices, HoldNoneOfManyThatAreEqual)
{
    TriangleIndices indices;
    for (int i = 0; i < 1000; ++i)
        indices.push_back(3);
    EXPECT_EQ(indices.size(), 1000u);
    EXPECT_EQ(indices[999], 3u);
    indices.set(5, 3);
    EXPECT_EQ(indices.bytes(), 0u);
    const std::vector<int> some { 7, 8 };
    EXPECT_EQ(picked(indices, some), (TriangleIndices { 3, 3 }));
    EXPECT_EQ(picked(indices, some).bytes(), 0u);
    indices.push_back(4);
    EXPECT_GE(indices.bytes(), 1001 * sizeof(uint32_t));
    EXPECT_EQ(indices[0], 3u);
    EXPECT_EQ(indices[1000], 4u);
}

TEST(TriangleIndices, OfWhichManyAreExpectedDoNotMove)
{
    TriangleIndices indices;
    indices.reserve(1000);
    for (uint32_t i = 0; i < 1000; ++i)
        indices.push_back(i / 500);
    EXPECT_EQ(indices.bytes(), 1000 * sizeof(uint32_t)) << "vectors that grow hold up to twice as many";
}

TEST(TriangleIndices, AreAVector)
{
    for (uint32_t seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        TriangleIndices indices;
        std::vector<uint32_t> expected;
        const uint32_t kinds = 1 + random() % 2;
        for (int step = 0; step < 20; ++step) {
            const uint32_t index = random() % kinds, count = random() % 5;
            switch (random() % 6) {
            case 0:
            case 1:
                indices.push_back(index);
                expected.push_back(index);
                break;
            case 2:
                if (!expected.empty()) {
                    const size_t triangle = random() % expected.size();
                    indices.set(triangle, index);
                    expected[triangle] = index;
                }
                break;
            case 3:
                indices.resize(count);
                expected.resize(count);
                break;
            case 4:
                indices.assign(count, index);
                expected.assign(count, index);
                break;
            default:
                if (random() % 4 == 0) {
                    indices.clear();
                    expected.clear();
                }
            }
            ASSERT_EQ(indices.size(), expected.size()) << seed;
            ASSERT_EQ(indices.empty(), expected.empty()) << seed;
            ASSERT_EQ(std::vector<uint32_t>(indices.begin(), indices.end()), expected) << seed;
            ASSERT_EQ(indices, TriangleIndices(expected)) << seed;
        }
    }
}
