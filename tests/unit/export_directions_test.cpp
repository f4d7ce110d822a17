// SPDX-License-Identifier: Apache-2.0
// Ambient occlusion and bent normals: what an engine decodes is what was baked.
#include "baked_map.h"
#include "scenes.h"
#include "strand_bake.h"

#include <vmlight/export/map_textures.h>
#include <vmlight/image/texture_file.h>

#include <gmock/gmock.h>

#include <cmath>

using namespace vmlight;
using Imath::V3d;
using Imath::V3f;
using testing::HasSubstr;

namespace {

constexpr int kSide = 64;

// Curved, with a mirrored half: a sphere under a roof, whose texture runs backwards for y < 0.
Mesh mirrored_sphere()
{
    Mesh mesh = scenes::sphere(V3d(0), 1, 12);
    for (size_t v = 0; v < mesh.uvs.size(); ++v)
        mesh.uvs[v].x = mesh.uvs[v].x < 0.5f ? 0.48f * mesh.uvs[v].x / 0.5f : 1.5f - mesh.uvs[v].x;
    // The column at u = 0.5 belongs to both halves.
    Mesh halves;
    halves.name = "halves";
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        Mesh one = mesh;
        one.triangles = { mesh.triangles[t] };
        std::array<uint32_t, 3> triangle;
        double y = 0;
        for (uint32_t v : mesh.triangles[t])
            y += mesh.positions[v].y / 3;
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t v = mesh.triangles[t][k];
            triangle[k] = uint32_t(halves.positions.size());
            halves.positions.push_back(mesh.positions[v]);
            halves.normals.push_back(mesh.normals[v]);
            Imath::V2f uv = mesh.uvs[v];
            if (y > 0 && uv.x > 0.5f)
                uv.x = 0.48f;
            if (y < 0 && uv.x < 0.5f)
                uv.x = 1;
            halves.uvs.push_back(uv);
        }
        halves.triangles.push_back(triangle);
    }
    halves.triangle_materials.assign(halves.triangles.size(), 0);
    return halves;
}

struct Exported
{
    explicit Exported(const Mesh& given, const std::vector<Mesh>& occluders = {}, int margin = 0)
        : mesh(given)
        , map(mesh, occluders, params(margin))
        , surface(mesh, kSide, kSide, 1001, 1)
    {
        std::string error;
        EXPECT_TRUE(texels.open(map.image(), &surface, error)) << error;
    }
    static VismapParams params(int margin)
    {
        VismapParams params = map_params(kSide, kSide, 64);
        params.margin = margin;
        return params;
    }
    // What a file holds, as an engine samples it.
    static OIIO::ImageBuf stored(const OIIO::ImageBuf& texture, TextureDepth depth)
    {
        OIIO::ImageBuf result = texture.copy(OIIO::TypeFloat);
        auto* value = static_cast<float*>(result.localpixels());
        const double steps = largest_of(depth);
        for (size_t i = 0; i < texture.spec().image_pixels() * size_t(texture.nchannels()); ++i)
            value[i] = float(std::round(double(value[i]) * steps) / steps);
        return result;
    }

    Mesh mesh;
    BakedMap map;
    TexelSurface surface;
    MapTexels texels;
};

V3d texel_of(const OIIO::ImageBuf& image, size_t index)
{
    const auto* value = static_cast<const float*>(image.localpixels()) + 3 * index;
    return V3d(double(value[0]), double(value[1]), double(value[2]));
}

} // namespace

// As MikkTSpace decodes: x T + y B + z N, of interpolated axes, normalised. The engine's frame is the mesh's own,
// whatever way green points.
TEST(ExportDirections, DecodedBentNormalsAreTheMeanOpenDirectionWithinAStep)
{
    Exported scene(mirrored_sphere(), { scenes::quad({ -9, 1.5, -9 }, { -9, 1.5, 9 }, { 9, 1.5, 9 }, { 9, 1.5, -9 }) });
    const MapTexels::Directions directions = scene.texels.tangent_directions();
    EXPECT_EQ(directions.behind, 0);
    for (const TextureDepth depth : { TextureDepth::Eight, TextureDepth::Sixteen })
        for (const bool is_up : { true, false }) {
            const OIIO::ImageBuf texture = Exported::stored(normal_texture(directions, kSide, kSide, is_up), depth);
            int64_t compared = 0, mirrored = 0;
            double farthest = 0, bent = 0;
            scene.surface.for_each([&](size_t i, const TangentSpace& frame) {
                const Texel texel = scene.map.at(int(i) % kSide, int(i) / kSide);
                if (texel.direction == V3f(0))
                    return;
                V3d local = texel_of(texture, i) * 2.0 - V3d(1);
                if (!is_up)
                    local.y = -local.y;
                const V3d decoded = frame.to_object(local).normalized();
                const V3d truth = V3d(texel.direction).normalized();
                farthest = std::max(farthest, (decoded - truth).length());
                bent = std::max(bent, (truth - frame.normal.normalized()).length());
                mirrored += frame.tangent.cross(frame.bitangent).dot(frame.normal) < 0;
                ++compared;
            });
            EXPECT_GT(compared, 2000);
            EXPECT_GT(mirrored, 500); // so that the sign of the bitangent matters
            EXPECT_GT(bent, 0.3); // so that normals alone would not pass
            // Half a step of 2 / steps in each of three axes; frames inside triangles are up to 1 % from orthonormal.
            EXPECT_LT(farthest, 1.02 * std::sqrt(3.0) / largest_of(depth)) << is_up;
        }
}

TEST(ExportDirections, GreenIsUpInTheTextureUnlessItIsDown)
{
    // On a floor in z = 0, u is x and v is y. A wall at x = 1 bends all to -x, one at y = 1 to -y.
    Exported scene(scenes::floor_facing_z(0.9), { scenes::rectangle(V3d(-9, 1, 0), V3d(0, 0, 9), V3d(18, 0, 0)) });
    const MapTexels::Directions directions = scene.texels.tangent_directions();
    const auto middle = size_t(kSide / 2 * kSide + kSide / 2);
    EXPECT_LT(directions.texels[middle].y, -0.1f);
    EXPECT_NEAR(double(directions.texels[middle].x), 0, 0.02); // of 64 rays
    EXPECT_LT(texel_of(normal_texture(directions, kSide, kSide, true), middle).y, 0.45);
    EXPECT_GT(texel_of(normal_texture(directions, kSide, kSide, false), middle).y, 0.55);
}

TEST(ExportDirections, ObjectSpaceIsTheMapsOwn)
{
    Exported scene(mirrored_sphere());
    const OIIO::ImageBuf texture
        = Exported::stored(normal_texture(scene.texels.object_directions(), kSide, kSide, true), TextureDepth::Sixteen);
    scene.map.each([&](const Texel& texel, int x, int y) {
        if (texel.direction == V3f(0))
            return;
        const V3d decoded = texel_of(texture, size_t(y * kSide + x)) * 2.0 - V3d(1);
        EXPECT_LT((decoded - V3d(texel.direction).normalized()).length(), std::sqrt(3.0) / 65535);
    });
}

TEST(ExportDirections, OcclusionIsVisibilityWithinHalfAStep)
{
    Exported scene(scenes::floor_facing_z(0.9), { scenes::wall_at_x1() });
    const OIIO::ImageBuf occlusion = scene.texels.occlusion();
    for (const TextureDepth depth : { TextureDepth::Eight, TextureDepth::Sixteen }) {
        std::string png, error;
        ASSERT_TRUE(encode_png(png, occlusion, depth, error)) << error;
        OIIO::Filesystem::IOMemReader reader(png.data(), png.size());
        OIIO::ImageBuf read("ao.png", 0, 0, nullptr, nullptr, &reader);
        ASSERT_TRUE(read.read(0, 0, true, OIIO::TypeFloat)) << read.geterror();
        EXPECT_EQ(read.nativespec().format, depth == TextureDepth::Eight ? OIIO::TypeUInt8 : OIIO::TypeUInt16);
        ASSERT_EQ(read.nchannels(), 1);
        scene.map.each([&](const Texel& texel, int x, int y) {
            EXPECT_NEAR(double(read.getchannel(x, y, 0, 0)), double(texel.visibility), 0.5001 / largest_of(depth));
        });
    }
}

TEST(ExportDirections, GammaIsUndoneByItsPower)
{
    OIIO::ImageBuf occlusion(OIIO::ImageSpec(4, 1, 1, OIIO::TypeFloat));
    const float v[4] = { 0, 0.25f, 0.5f, 1 };
    std::copy_n(v, 4, static_cast<float*>(occlusion.localpixels()));
    apply_ao_gamma(occlusion, 2);
    for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(double(occlusion.getchannel(i, 0, 0, 0)), std::sqrt(double(v[i])), 1e-6);
}

// A closed texel is black, though all around it is filled: it is not what lies off the charts.
TEST(ExportDirections, ClosedTexelsStayBlackAndTextureSpaceAroundTheChartsIsFilled)
{
    Mesh mesh = scenes::floor_facing_z(1);
    for (auto& uv : mesh.uvs)
        uv = uv * 0.5f + Imath::V2f(0.25f, 0.25f);
    // Flat on the half x < 0: nothing is seen there. The other half is open.
    const Mesh lid = scenes::box(V3d(-1.5, -1.5, -0.5), V3d(-0.01, 1.5, 0.001), true);
    for (const bool knows_surface : { true, false }) {
        Exported scene(mesh, { lid });
        std::string error;
        if (!knows_surface) { // the channel `coverage` says the same
            ASSERT_TRUE(scene.texels.open(scene.map.image(), nullptr, error)) << error;
        }
        const OIIO::ImageBuf occlusion = scene.texels.occlusion();
        const int low = kSide / 4 + 2, high = 3 * kSide / 4 - 2, middle = kSide / 2;
        EXPECT_EQ(scene.map.at(low, middle).visibility, 0);
        EXPECT_EQ(occlusion.getchannel(low, middle, 0, 0), 0);
        EXPECT_EQ(occlusion.getchannel(high, middle, 0, 0), scene.map.at(high, middle).visibility);
        EXPECT_EQ(occlusion.getchannel(0, middle, 0, 0), 0); // beside the closed half
        EXPECT_GT(occlusion.getchannel(kSide - 1, middle, 0, 0), 0.5f); // beside the open one
        const MapTexels::Directions directions
            = knows_surface ? scene.texels.tangent_directions() : scene.texels.object_directions();
        for (const V3f& n : directions.texels) {
            EXPECT_NEAR(double(n.length()), 1, 1e-5);
            EXPECT_GT(n.z, 0);
        }
    }
}

// Those that the map was shaded with, if it has them: a page lights with them as makelightmap does.
TEST(ExportDirections, NormalsAreTheMapsOrElseTheMeshs)
{
    Exported scene(mirrored_sphere());
    const OIIO::ImageBuf of_mesh = scene.texels.normals(scene.surface);
    OIIO::ImageBuf map = scene.map.image().copy(OIIO::TypeFloat);
    OIIO::ImageSpec spec(kSide, kSide, 8, OIIO::TypeFloat);
    spec.channelnames
        = { "visibility", "direction.x", "direction.y", "direction.z", "coverage", "normal.x", "normal.y", "normal.z" };
    OIIO::ImageBuf with_normals(spec);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            float texel[8] = {};
            map.getpixel(x, y, 0, texel, 5);
            texel[5] = 1;
            with_normals.setpixel(x, y, texel, 8);
        }
    MapTexels texels;
    std::string error;
    ASSERT_TRUE(texels.open(with_normals, &scene.surface, error)) << error;
    const OIIO::ImageBuf of_map = texels.normals(scene.surface);
    scene.surface.for_each([&](size_t i, const TangentSpace& frame) {
        EXPECT_LT((texel_of(of_mesh, i) - frame.normal.normalized()).length(), 1e-6);
        EXPECT_EQ(texel_of(of_map, i), V3d(1, 0, 0));
    });
}

TEST(ExportDirections, WithoutAnythingOpenDirectionsAreTheNormal)
{
    Exported scene(scenes::sphere(V3d(0), 1, 8, true));
    for (const V3f& n : scene.texels.tangent_directions().texels)
        EXPECT_EQ(n, V3f(0, 0, 1));
    const OIIO::ImageBuf occlusion = scene.texels.occlusion();
    EXPECT_EQ(OIIO::ImageBuf(occlusion).getchannel(kSide / 2, kSide / 2, 0, 0), 0);
}

// The margin of a map repeats directions of object space; across a border of charts that turn, that is not tangent
// space.
TEST(ExportDirections, TheMarginOfATangentSpaceTextureIsOfItsOwnSpace)
{
    Exported with(mirrored_sphere(), {}, 4), without(mirrored_sphere(), {}, 0);
    EXPECT_EQ(with.texels.tangent_directions().texels, without.texels.tangent_directions().texels);
}

TEST(ExportDirections, TheWrongMeshShows)
{
    Exported scene(scenes::sphere(V3d(0), 1, 12));
    const Mesh other = scenes::sphere(V3d(0), 1, 12, true);
    const TexelSurface surface(other, kSide, kSide, 1001, 1);
    MapTexels texels;
    std::string error;
    ASSERT_TRUE(texels.open(scene.map.image(), &surface, error)) << error;
    EXPECT_GT(texels.tangent_directions().behind, surface.covered() / 2);
}

TEST(ExportDirections, WhatHasNoSurfaceIsRefused)
{
    MapTexels texels;
    std::string error;
    const OIIO::ImageBuf strands = strand_bake::strand_map(
        strand_files::straight({ { V3d(0, 0, 0), V3d(0, 1, 0) } }, 0.1), {}, strand_bake::rays(8));
    EXPECT_FALSE(texels.open(strands, nullptr, error));
    EXPECT_THAT(error, HasSubstr("strands"));
    OIIO::ImageBuf part = BakedMap(scenes::floor_facing_z(1), {}, map_params(8, 8, 1)).image();
    part.specmod().full_width = 16;
    EXPECT_FALSE(texels.open(part, nullptr, error));
    EXPECT_THAT(error, HasSubstr("only part of a map"));
    OIIO::ImageBuf damaged = BakedMap(scenes::floor_facing_z(1), {}, map_params(8, 8, 1)).image();
    static_cast<float*>(damaged.localpixels())[size_t(8 * 2 + 3) * size_t(damaged.nchannels()) + 1] = NAN;
    EXPECT_FALSE(texels.open(damaged, nullptr, error));
    EXPECT_THAT(error, HasSubstr("pixel (3, 2) of channel direction.x is nan"));
    OIIO::ImageBuf picture(OIIO::ImageSpec(2, 2, 3, OIIO::TypeFloat));
    EXPECT_FALSE(texels.open(picture, nullptr, error));
    EXPECT_THAT(error, HasSubstr("visibility"));
}
