// SPDX-License-Identifier: Apache-2.0
// Differences of nearly equal numbers, sums of many, the processor's moods.
#include "cases.h"
#include "hard_case.h"

#include "cfem_maps.h"
#include "instruction_sets.h"
#include "scenes.h"
#include "stack_maps.h"
#include "stage_scene.h"

#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imagebufalgo.h>

#include <cmath>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

using namespace vmlight;
using Imath::V3d;
using Imath::V3f;

namespace {

const char* const kBases[] = { "vector", "sh", "mask", "cells" };

std::vector<OIIO::ImageBuf> bake_each_basis()
{
    const Mesh floor = scenes::floor_facing_z(2);
    const Mesh ball = scenes::sphere(V3d(0.3, 0.2, 1), 0.7, 12);
    std::vector<OIIO::ImageBuf> maps;
    for (const char* basis : kBases) {
        VismapParams params;
        params.resolution = { 24, 24 };
        params.samples = 64;
        params.basis = basis;
        EXPECT_TRUE(make_vismap(maps.emplace_back(), floor, { ball }, params)) << maps.back().geterror();
    }
    return maps;
}

// Hashes of all pixels of a stack, and of what it lights.
std::string light_each_model(const std::vector<OIIO::ImageBuf>& vismaps)
{
    std::string hashes;
    const auto add = [&](const OIIO::ImageBuf& image) { hashes += OIIO::ImageBufAlgo::computePixelHashSHA1(image); };
    const auto stack = scene::filtered_stack(cfem_maps::image(cfem_maps::random_map(64, 32, 2)), 32);
    for (const OIIO::ImageBuf& level : stack)
        add(level);
    for (const OIIO::ImageBuf& vismap : vismaps)
        for (const char* name : { "paper", "lobe", "auto" })
            add(scene::lit(vismap, stack, scene::model(name)));
    return hashes;
}

double largest_difference(const OIIO::ImageBuf& a, const OIIO::ImageBuf& b)
{
    const auto result = OIIO::ImageBufAlgo::compare(a, b, 0, 0);
    return result.maxerror;
}

} // namespace

TEST(Arithmetic, RowsNearThePole)
{
    HardCase row("The solid angle of the first row of 8192");
    const int height = 8192;
    const double truth = 4 * latlong::pi * std::pow(std::sin(latlong::pi / (2 * height)), 2);
    const float naive = 2 * float(latlong::pi) * (1 - std::cos(float(latlong::pi) / height));
    EXPECT_GT(std::abs(naive / truth - 1), 0.1);
    row.naive("a difference of cosines in float: more than 10 % error");
    EXPECT_NEAR(latlong::row_solid_angle(0, height) / truth, 1, 1e-14);
    double sum = 0;
    for (int y = 0; y < height; ++y)
        sum += latlong::row_solid_angle(y, height);
    EXPECT_NEAR(sum, 4 * latlong::pi, 1e-12);
    row.ours("as a product: accurate to 1e-14; the rows sum to the sphere within 1e-13");
}

TEST(Arithmetic, LargeSumsLoseNothing)
{
    HardCase row("The sum of 134 million texels of 0.1");
    const int width = 16384, height = 8192;
    float naive = 0;
    for (int64_t i = 0; i < int64_t(width) * height; ++i)
        naive += 0.1f;
    EXPECT_LT(naive / (0.1 * width * height), 0.2);
    row.naive("in float: 16 % of the sum");
    const OIIO::ImageSpec spec(width, cases(height, 512), 3, OIIO::TypeFloat);
    const Environment environment(spec, [&](int, float* pixels, std::string&) {
        std::fill_n(pixels, size_t(3) * width, 0.1f);
        return true;
    });
    CfemParams params;
    params.resolution = { 4, 2 };
    OIIO::ImageBuf cfem;
    ASSERT_TRUE(make_cfem(cfem, environment, params)) << cfem.geterror();
    for (OIIO::ImageBuf::ConstIterator<float> p(cfem); !p.done(); ++p)
        EXPECT_NEAR(p[0], 0.1f, 7.5e-9f);
    row.ours("a mean of 0.1, to 1 ulp of float");
}

TEST(Arithmetic, InstructionSetsAgree)
{
    HardCase row("The same images on processors with SSE2, SSE4, AVX2 and AVX-512");
    std::mt19937 random(4);
    std::normal_distribution<float> normal;
    int apart = 0;
    for (int i = 0; i < 1000; ++i) {
        const V3f a(normal(random), normal(random), normal(random)), b(normal(random), normal(random), normal(random));
        const volatile float xx = a.x * b.x, yy = a.y * b.y, zz = a.z * b.z;
        const volatile float xy = xx + yy;
        apart += float(xy + zz) != std::fma(a.z, b.z, std::fma(a.y, b.y, xx));
    }
    EXPECT_GT(apart, 300);
    row.naive("with and without fused multiplication: hundreds of 1000 scalar products differ");

    const std::vector<OIIO::ImageBuf> baked = bake_each_basis();
    const std::string lit = light_each_model(baked);
    double worst = 0;
    with_each_instruction_set([&](const char* instruction_set) {
        EXPECT_EQ(light_each_model(baked), lit) << instruction_set;
        const std::vector<OIIO::ImageBuf> again = bake_each_basis();
        for (size_t i = 0; i < baked.size(); ++i)
            worst = std::max(worst, largest_difference(again[i], baked[i]));
    });
    // Sums of directions are made lane by lane.
    EXPECT_LE(worst, 4 * 0x1p-23);
    row.ours("filters and models are bit-equal; bakes agree to 4 ulps of 1, packed numbers exactly");
}

TEST(Arithmetic, DenormalsOfTheHost)
{
    HardCase row("A reader bakes on a host's thread; Embree wants denormals flushed to 0 there", "OIIO PR#2048");
#if defined(__SSE__)
    const volatile float tiny = 1e-40f;
    const unsigned before = _mm_getcsr() & 0xffc0; // but for the flags of what happened
    _mm_setcsr(_mm_getcsr() | 0x8040);
    EXPECT_EQ(tiny * 0.5f, 0);
    _mm_setcsr((_mm_getcsr() & ~0xffc0u) | before);
    row.naive("from then on the host's own 1e-40 is 0");
    const stage_scene::Folder folder;
    stage_scene::all_pixels(*OIIO::ImageInput::open(folder / "hero.lightmap"));
    EXPECT_EQ(_mm_getcsr() & 0xffc0, before);
    EXPECT_GT(tiny * 0.5f, 0);
    row.ours("the thread's floating-point mode is restored after every read");
#else
    GTEST_SKIP() << "no such mode is set on this processor";
#endif
}
