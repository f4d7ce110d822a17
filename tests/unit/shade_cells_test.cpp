// SPDX-License-Identifier: Apache-2.0
// The kernels of `mask` and `cells` against their scalar forms, and those against sums over single cells in double.
#include "instruction_sets.h"
#include "lightmap_scene.h"

#include <vmlight/lightmap/cell_sums.h>
#include <vmlight/lightmap/model_cells.h>
#include <vmlight/lightmap/model_mask.h>

#include <cfloat>

using namespace vmlight;
using namespace scene;
using namespace direction_grid;

namespace {

using Shade = bool (*)(const CellLight&, const ShadeSetup&, const float*, size_t, float*);

struct Kernel
{
    const char* name;
    bool (*build)(CellLight&, const ImageBuf&, const Rotation&, std::string&);
    Shade shade, scalar;
    int packed;
    int texel() const { return kBeforePacked + packed; }
};

const Kernel kKernels[] = {
    { "mask", build_mask_light, shade_mask, shade_mask_scalar, kMaskFloats },
    { "cells", build_cells_light, shade_cells, shade_cells_scalar, kCellsFloats },
};

const ShadeSetup kSetup { { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, 1.5f };

CellLight light_of(const Kernel& kernel, const ImageBuf& environment)
{
    CellLight light;
    std::string error;
    EXPECT_TRUE(kernel.build(light, environment, rotation_from_angles(20, 35, -50), error)) << error;
    return light;
}

// A sky and a sun of 1.4 degrees, which has thirty times the light of the sky.
ImageBuf sunny()
{
    ImageBuf map
        = cfem(256, 128, [](V3d w) { return V3f(float(2 + w.y), float(1 + 0.5 * w.x), float(1 - 0.7 * w.z)); });
    const float bright[3] { 2e6f, 1.5e6f, 1e6f };
    map.setpixel(70, 30, bright, 3);
    return map;
}

// Visibility as bakes make it: of intervals and cells above the horizon of n, some in part.
struct Texels
{
    std::vector<float> values;
    std::vector<std::array<MaskColumn, kColumns>> columns;
    std::vector<std::array<uint8_t, kCells>> thirds;
};

Texels like_baked(const Kernel& kernel, int count)
{
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> unit;
    Texels texels;
    for (int i = 0; i < count; ++i) {
        const V3f n = V3f(normal(random), normal(random), normal(random)).normalized();
        const float open = unit(random); // how much of the hemisphere is visible
        auto& columns = texels.columns.emplace_back();
        auto& thirds = texels.thirds.emplace_back();
        for (int column = 0; column < kColumns; ++column) {
            MaskColumn& view = columns[size_t(column)];
            for (int slice = 0; slice < kSlices; ++slice) {
                const auto& moments = running_moments()[size_t(column)];
                if (V3d(n).dot(moments[size_t(slice) + 1] - moments[size_t(slice)]) <= 0)
                    continue;
                view.low = view.high == 0 ? slice : view.low;
                view.high = slice + 1;
            }
            view.density = unit(random) < open ? 1 + int(random() % 15) : 0;
            if (view.high <= view.low || view.density == 0)
                view = {};
            for (int band = 0; band < kBands; ++band)
                if (view.low < (band + 1) * kSlicesPerBand && view.high > band * kSlicesPerBand)
                    thirds[size_t(band * kColumns + column)] = unit(random) < open ? 3 : uint8_t(random() % 4);
        }
        const V3f b = n * (open * 0.6f);
        texels.values.insert(texels.values.end(), { open, b.x, b.y, b.z, n.x, n.y, n.z });
        std::vector<float> packed(size_t(kernel.packed));
        if (kernel.packed == kMaskFloats)
            pack_mask(packed.data(), columns.data());
        else
            pack_cells(packed.data(), thirds.data());
        texels.values.insert(texels.values.end(), packed.begin(), packed.end());
    }
    return texels;
}

// Sum of visible cells, one by one.
CellMoments sum_of_cells(const Kernel& kernel, const Texels& texels, size_t texel,
                         const std::vector<CellMoments>& cells)
{
    CellMoments sum {};
    for (int column = 0; column < kColumns; ++column)
        for (int slice = 0; slice < kSlices; ++slice) {
            const MaskColumn& view = texels.columns[texel][size_t(column)];
            const int visible = kernel.packed == kCellsFloats
                ? texels.thirds[texel][size_t(slice / kSlicesPerBand * kColumns + column)]
                : slice >= view.low && slice < view.high ? view.density
                                                         : 0;
            for (size_t k = 0; k < sum.size(); ++k)
                sum[k] += visible * cells[size_t(column * kSlices + slice)][k];
        }
    return sum;
}

struct Expected
{
    V3d color { 0, 0, 0 };
    V3d rounding { 0, 0, 0 }; // the most that rounded entries can change
};

Expected expected_light(const Kernel& kernel, const CellMoments& sum, const CellLight& light, const float* texel)
{
    const V3d n(texel[4], texel[5], texel[6]);
    const double entries = kernel.packed == kCellsFloats ? kCellsParts : 2 * kColumns;
    const double off = 0.5 * entries * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    std::array<double, 4> along {};
    for (size_t lane = 0; lane < 4; ++lane)
        along[lane] = n.x * sum[lane] + n.y * sum[4 + lane] + n.z * sum[8 + lane];
    const double angle = sum[15], cosine = angle > 0 ? along[3] / angle : 0;
    const double even = std::max(0.0, 1 - cosine / kLeastCosine), weight = along[3] + even * angle;
    const double off_weight = off * double(light.unit[3]), off_even = angle > 0 ? off_weight / angle / kLeastCosine : 0;
    Expected expected;
    for (int c = 0; c < 3; ++c) {
        const double plain = sum[size_t(12 + c)], gain = double(kSetup.gain * texel[0]);
        const double seen = weight > 0 ? (along[size_t(c)] + even * plain) / weight : 0;
        const double within = std::clamp(double(light.mean[c]) + seen, double(light.least[c]), double(light.most[c]));
        expected.color[c] = std::min(gain * within, double(kSetup.gain * light.brightest[c] * kAboveRounding));
        const double change = off * double(light.unit[c]) + off_even * std::abs(plain)
            + std::abs(seen) * (off_weight + off_even * angle);
        expected.rounding[c] = weight > 0 ? gain * change / std::max(weight - off_weight - off_even * angle, 1e-9) : 0;
    }
    return expected;
}

} // namespace

TEST(ShadeCells, EveryInstructionSetGivesTheBitsOfTheScalarForm)
{
    for (const Kernel& kernel : kKernels) {
        const CellLight light = light_of(kernel, random_cfem(37, 18));
        constexpr int count = 997;
        std::vector<float> in = like_baked(kernel, count).values;
        std::mt19937 random(7);
        std::normal_distribution<float> normal;
        for (size_t i = 0; i < in.size(); ++i) // what no bake makes
            if (random() % 16 == 0) {
                const bool packed = i % size_t(kernel.texel()) >= size_t(kBeforePacked);
                const float kinds[] { normal(random),
                                      0.0f,
                                      -0.0f,
                                      1e-7f * normal(random),
                                      1e30f * normal(random),
                                      float(random() >> 8),
                                      1e-40f,
                                      16777215.0f,
                                      16777216.0f };
                in[i] = kinds[packed && random() % 4 ? 5 : random() % 9];
            }
        with_each_instruction_set([&](const char* instruction_set) {
            for (int texels : { 0, 1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 31, 33, 127, 128, 129, count }) {
                // No more than the texels, so that sanitizers see what lies beyond.
                const std::vector<float> texel(in.begin(), in.begin() + texels * kernel.texel());
                std::vector<float> expected(3 * count + 1, -7), got(3 * count + 1, -7);
                EXPECT_EQ(kernel.scalar(light, kSetup, texel.data(), size_t(texels), expected.data()),
                          kernel.shade(light, kSetup, texel.data(), size_t(texels), got.data()));
                EXPECT_EQ(std::memcmp(expected.data(), got.data(), 4 * expected.size()), 0)
                    << kernel.name << ", " << instruction_set << ", " << texels << " texels";
            }
        });
    }
}

TEST(ShadeCells, LightIsThatOfTheSumOverSingleCells)
{
    constexpr int count = 800;
    for (const Kernel& kernel : kKernels)
        for (const ImageBuf& environment : { random_cfem(64, 32), sunny() }) {
            const CellLight light = light_of(kernel, environment);
            std::vector<CellMoments> cells;
            EnvironmentBounds bounds;
            std::string error;
            ASSERT_TRUE(bin_environment(cells, bounds, environment, rotation_from_angles(20, 35, -50), error)) << error;
            const Texels texels = like_baked(kernel, count);
            std::vector<float> out(3 * count);
            ASSERT_TRUE(kernel.shade(light, kSetup, texels.values.data(), count, out.data()));
            const std::string what = std::string(kernel.name) + (environment.spec().width == 256 ? "_sunny" : "");
            double squares = 0, mean = 0;
            for (int i = 0; i < count; ++i) {
                const float* texel = &texels.values[size_t(i * kernel.texel())];
                const Expected expected
                    = expected_light(kernel, sum_of_cells(kernel, texels, size_t(i), cells), light, texel);
                for (int c = 0; c < 3; ++c) {
                    const double off = std::abs(double(out[size_t(3 * i + c)]) - expected.color[c]);
                    EXPECT_LE(off, expected.rounding[c] + 2e-5 * double(kSetup.gain * light.mean[c]))
                        << what << " " << i;
                    squares += off * off / (3 * count);
                    mean += expected.color[c] / (3 * count);
                }
            }
            RecordProperty("rms_" + what, std::to_string(std::sqrt(squares) / mean * 1e6) + "e-6");
            // The models themselves are off by a tenth of the mean light.
            EXPECT_LT(std::sqrt(squares), 3e-4 * mean) << what;
        }
}

TEST(ShadeCells, SumsOfTheWholeSphereFitTheFixedPoint)
{
    for (const Kernel& kernel : kKernels) {
        const CellLight light = light_of(kernel, sunny());
        const auto field = [&](const PackedMoments& entry, int lane, int axis) {
            return double(unpack_moment(entry.lanes[lane], axis));
        };
        const bool cells = kernel.packed == kCellsFloats;
        const size_t parts = cells ? size_t(kCellsParts) : size_t(kColumns), codes = cells ? kCellsCodes : kMaskCodes,
                     stride = cells ? size_t(kCellsStride) : size_t(kMaskStride);
        for (int lane = 0; lane < kMomentLanes; ++lane)
            for (int axis = 0; axis < 3; ++axis) {
                double most = 0;
                for (size_t part = 0; part < parts; ++part) {
                    double largest = 0, least = 0;
                    for (size_t code = 0; code < codes; ++code) {
                        const double value = field(light.moments[part * stride + code], lane, axis);
                        largest = std::max(largest, value);
                        least = std::min(least, value);
                    }
                    most += cells ? std::max(largest, -least) : largest - least;
                }
                EXPECT_LE(most, kMomentBias) << kernel.name << " " << lane << " " << axis;
            }
        for (size_t lane = 0; lane < 4; ++lane)
            EXPECT_EQ(light.moments[0].lanes[lane], 0); // nothing is visible
    }
}

TEST(ShadeCells, NoInputLeadsOutsideTheTablesAndNoBadOneGoesUnseen)
{
    const float bad[] { NAN, INFINITY, -INFINITY, FLT_MAX, -1, 0.5f, 0x1p24f };
    for (const Kernel& kernel : kKernels) {
        const CellLight light = light_of(kernel, random_cfem(5, 3));
        const std::vector<float> good = like_baked(kernel, 1).values;
        float out[3], scalar[3];
        ASSERT_TRUE(kernel.shade(light, kSetup, good.data(), 1, out));
        EXPECT_TRUE(std::isfinite(out[0] + out[1] + out[2]));
        for (size_t i = 0; i < good.size(); ++i)
            for (const float value : bad) {
                const bool is_normal = i >= 4 && i < size_t(kBeforePacked), is_packed = i >= size_t(kBeforePacked);
                std::vector<float> in = good;
                in[i] = value;
                const bool sound = kernel.shade(light, kSetup, in.data(), 1, out);
                EXPECT_EQ(sound, kernel.scalar(light, kSetup, in.data(), 1, scalar));
                const bool is_bad
                    = is_packed || (i == 0 && !(std::abs(value) <= 2)) || (is_normal && !(std::abs(value) < 1e19f));
                EXPECT_FALSE(is_bad && sound) << kernel.name << " " << i << " " << value;
                EXPECT_TRUE(!sound || std::isfinite(out[0] + out[1] + out[2]));
            }
        for (const float v : { 0.0f, -0.0f, -1.0f }) {
            std::vector<float> in = good;
            in[0] = v;
            EXPECT_TRUE(kernel.shade(light, kSetup, in.data(), 1, out));
            EXPECT_EQ(out[0] + out[1] + out[2], 0) << v;
        }
    }
}
