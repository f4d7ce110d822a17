// SPDX-License-Identifier: Apache-2.0
// Normal maps: what their pixels mean.
#include "scenes.h"

#include <vmlight/vismap/normal_map.h>

#include <OpenImageIO/imagebufalgo.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

using namespace vmlight;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;
using OIIO::ImageBuf;
using OIIO::ImageSpec;
using testing::HasSubstr;

namespace {

ImageBuf constant(const std::vector<float>& color, OIIO::TypeDesc format = OIIO::TypeDesc::FLOAT, int side = 4)
{
    ImageBuf image(ImageSpec(side, side, int(color.size()), format));
    OIIO::ImageBufAlgo::fill(image, color);
    return image;
}

ImageBuf encoded(const V3d& n, OIIO::TypeDesc format = OIIO::TypeDesc::FLOAT)
{
    return constant({ float(n.x + 1) / 2, float(n.y + 1) / 2, float(n.z + 1) / 2 }, format);
}

struct Decoded
{
    NormalMap map;
    std::vector<std::string> warnings;
    std::string error;
    bool is_read = false;
};

Decoded decoded(const ImageBuf& image, const Mesh& mesh = scenes::floor_facing_z(1), const NormalMapParams& params = {})
{
    Decoded result;
    result.is_read = result.map.decode(image, params, { 4, 4 }, 1, result.warnings, result.error);
    if (result.is_read)
        result.map.attach(std::make_shared<const Mesh>(mesh));
    return result;
}

V3d mapped(const Decoded& decoded)
{
    EXPECT_TRUE(decoded.is_read) << decoded.error;
    SurfacePoint point;
    point.normal = point.mesh_normal = V3f(0, 0, 1);
    decoded.map.apply(point, 0, 0.25f, 0.25f, 1, 2);
    EXPECT_EQ(point.mesh_normal, V3f(0, 0, 1));
    return V3d(point.normal);
}

} // namespace

TEST(NormalMap, LeansAlongTheTexture)
{
    const V3d n = V3d(0.3, 0.5, 0.7).normalized();
    NormalMapParams down, object;
    down.normal_map_green = "down";
    object.normal_map_space = "object";
    EXPECT_LT((mapped(decoded(encoded(n))) - n).length(), 1e-6);
    EXPECT_LT((mapped(decoded(encoded(n), scenes::floor_facing_z(1), down)) - V3d(n.x, -n.y, n.z)).length(), 1e-6);
    Mesh mirrored = scenes::floor_facing_z(1);
    for (V2f& uv : mirrored.uvs)
        uv.x = 1 - uv.x;
    EXPECT_LT((mapped(decoded(encoded(n), mirrored)) - V3d(-n.x, n.y, n.z)).length(), 1e-6);
    EXPECT_LT((mapped(decoded(encoded(n), mirrored, object)) - n).length(), 1e-6);
}

TEST(NormalMap, AnyEncodingIsTheSame)
{
    const V3d n = V3d(-0.6, 0.2, 0.5).normalized();
    EXPECT_LT((mapped(decoded(constant({ float(n.x), float(n.y), float(n.z) }))) - n).length(), 1e-6) << "signed";
    EXPECT_LT((mapped(decoded(encoded(n, OIIO::TypeDesc::UINT8))) - n).length(), 0.01) << "8 bit";
    EXPECT_LT((mapped(decoded(encoded(n, OIIO::TypeDesc::UINT16))) - n).length(), 1e-4) << "16 bit";
    EXPECT_LT((mapped(decoded(constant({ float(n.x + 1) / 2, float(n.y + 1) / 2 }))) - n).length(), 1e-6) << "no B";
    ImageBuf other_order(ImageSpec(4, 4, 4, OIIO::TypeDesc::FLOAT));
    OIIO::ImageBufAlgo::fill(other_order, { 1.0f, float(n.z + 1) / 2, float(n.y + 1) / 2, float(n.x + 1) / 2 });
    other_order.specmod().channelnames = { "A", "B", "G", "R" };
    EXPECT_LT((mapped(decoded(other_order)) - n).length(), 1e-6) << "by name";
}

TEST(NormalMap, StraightUpChangesNothing)
{
    for (const float middle : { 127 / 255.0f, 128 / 255.0f, 0.5f }) {
        const Decoded flat = decoded(constant({ middle, middle, 1 }));
        EXPECT_TRUE(flat.map.is_flat()) << middle;
        SurfacePoint point;
        point.normal = V3f(0, 0.6f, 0.8f);
        flat.map.apply(point, 0, 0.25f, 0.25f, 1, 1);
        EXPECT_EQ(point.normal, V3f(0, 0.6f, 0.8f));
    }
    EXPECT_FALSE(decoded(constant({ 0.51f, 0.5f, 1 })).map.is_flat());
    NormalMapParams object;
    object.normal_map_space = "object";
    EXPECT_FALSE(decoded(constant({ 0.5f, 0.5f, 1 }), scenes::floor_facing_z(1), object).map.is_flat());
}

TEST(NormalMap, OtherSizesAreFiltered)
{
    ImageBuf image(ImageSpec(16, 16, 3, OIIO::TypeDesc::FLOAT));
    const float left[3] { 0.8f, 0.5f, 0.9f }, right[3] { 0.2f, 0.5f, 0.9f };
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            image.setpixel(x, y, x % 2 ? left : right);
    // Bumps finer than a texel cancel.
    EXPECT_LT((mapped(decoded(image)) - V3d(0, 0, 1)).length(), 1e-5);
}

TEST(NormalMap, OtherImagesAreRefused)
{
    EXPECT_THAT(decoded(constant({ 0.5f })).error, HasSubstr("a bump or height map"));
    EXPECT_THAT(decoded(constant({ 0.5f, 0.5f, 0.5f })).error, HasSubstr("100 % of its pixels are not unit vectors"));
    ImageBuf broken = constant({ 0.5f, 0.5f, 1 });
    const float nan[3] { 0.5f, NAN, 1 };
    broken.setpixel(3, 1, nan);
    EXPECT_THAT(decoded(broken).error, HasSubstr("pixel (3, 1) is nan"));
    ImageBuf holes(ImageSpec(10, 10, 3, OIIO::TypeDesc::FLOAT));
    OIIO::ImageBufAlgo::fill(holes, { 0.7f, 0.5f, 0.95f });
    const float gray[3] { 0.5f, 0.5f, 0.5f };
    for (int x = 0; x < 4; ++x)
        holes.setpixel(x, 0, gray);
    EXPECT_THAT(decoded(holes).warnings, testing::ElementsAre(HasSubstr("4.0 % of its pixels are not unit vectors")));
    EXPECT_THAT(decoded(constant({ 0.9f, 0.5f, 0.2f })).warnings,
                testing::ElementsAre(HasSubstr("100.0 % of its normals point into the surface")));
}
