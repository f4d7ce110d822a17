// SPDX-License-Identifier: Apache-2.0
// Visibility under normal maps: closed forms, and a displaced surface.
#include "baked_map.h"
#include "scenes.h"

#include <vmlight/vismap/baker.h>

#include <OpenImageIO/imagebufalgo.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

using namespace vmlight;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;
using OIIO::ImageBuf;

namespace {

struct MappedTexel
{
    double visibility;
    V3d direction, normal;
};

// Bakes a mesh with the normal map that normal(s, t) gives, in any space.
class MappedBake
{
public:
    MappedBake(const Mesh& mesh, const std::function<V3d(double s, double t)>& normal, VismapParams params,
               const std::vector<Mesh>& occluders = {}, const std::string& space = "tangent", int nthreads = 0)
    {
        const Size size = params.size();
        ImageBuf image(OIIO::ImageSpec(size.width, size.height, 3, OIIO::TypeDesc::FLOAT));
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x) {
                const V3d n = normal((x + 0.5) / size.width, (y + 0.5) / size.height);
                const float pixel[3] { float(n.x + 1) / 2, float(n.y + 1) / 2, float(n.z + 1) / 2 };
                image.setpixel(x, y, pixel);
            }
        auto map = std::make_shared<NormalMap>();
        NormalMapParams how;
        how.normal_map_space = space;
        std::vector<std::string> warnings;
        std::string error;
        EXPECT_TRUE(map->decode(image, how, size, 1, warnings, error)) << error;
        auto scene = std::make_shared<BakeScene>();
        EXPECT_TRUE(scene->build(non_owning(mesh), occluders, 0, error)) << error;
        map->attach(non_owning(mesh));
        params.channels = { "normal", "coverage" };
        EXPECT_TRUE(make_vismap(m_image, scene, params, &report, nthreads, {}, 0, map)) << m_image.geterror();
    }
    MappedTexel at(int x, int y) const
    {
        const int normal = m_image.spec().channelindex("normal.x");
        const auto value = [&](int c) { return double(m_image.getchannel(x, y, 0, c)); };
        return { value(0), V3d(value(1), value(2), value(3)),
                 V3d(value(normal), value(normal + 1), value(normal + 2)) };
    }
    const ImageBuf& image() const { return m_image; }

    VismapReport report;

private:
    ImageBuf m_image;
};

bool same_pixels(const ImageBuf& a, const ImageBuf& b)
{
    return std::memcmp(a.localpixels(), b.localpixels(), size_t(a.spec().image_bytes())) == 0;
}

} // namespace

// What leans by an angle sees its own surface rise to that angle: as beside a wall (vismap_closed_forms_test.cpp).
TEST(NormalMapBake, TheSurfaceItselfIsTheHorizon)
{
    for (const double angle : { 0.2, 0.7, 1.2 }) {
        const V3d normal(std::sin(angle), 0, std::cos(angle)), along(std::cos(angle), 0, -std::sin(angle));
        const double visibility = (1 + std::cos(angle)) / 2;
        const V3d direction = along * (-2 / (3 * M_PI) * std::pow(std::sin(angle), 2))
            + normal * (2.0 / 3 - 2 / (3 * M_PI) * (angle - std::sin(angle) * std::cos(angle)));
        const MappedBake bake(
            scenes::floor_facing_z(1), [&](double, double) { return normal; }, map_params(8, 8, 4096));
        for (int x = 0; x < 8; ++x) {
            const MappedTexel texel = bake.at(x, 3);
            EXPECT_LT((texel.normal - normal).length(), 1e-6) << angle;
            EXPECT_NEAR(texel.visibility, visibility, 3e-3) << angle;
            EXPECT_LT((texel.direction - direction).length(), 3e-3) << angle;
        }
        // Rays into the surface are known to be blocked.
        EXPECT_LT(double(bake.report.rays), 64 * 4096 * (visibility + 0.01));
        EXPECT_GT(double(bake.report.rays), 64 * 4096 * (visibility - 0.01));
    }
}

// Coarse meshes with smooth normals: directions between both horizons stay left out.
TEST(NormalMapBake, ASmoothNormalIsNotBlockedByItsFacet)
{
    Mesh mesh = scenes::floor_facing_z(1);
    const V3d smooth = V3d(0.4, 0, 1).normalized();
    mesh.normals.assign(mesh.normals.size(), V3f(smooth));
    const BakedMap plain(mesh, {}, map_params(8, 8, 256));
    const auto nearly = [&](double lean) {
        return MappedBake(
                   mesh, [=](double, double) { return V3d(std::sin(lean), 0, std::cos(lean)); }, map_params(8, 8, 256))
            .at(4, 4);
    };
    EXPECT_EQ(plain.at(4, 4).visibility, 1);
    EXPECT_GT(nearly(0.02).visibility, 0.99);
    // Further out than the facet's own horizon it is blocked.
    EXPECT_NEAR(nearly(0.6).visibility, (1 + std::cos(0.6)) / 2, 0.15);
}

TEST(NormalMapBake, ObjectSpaceIsTheSameNormal)
{
    Mesh mesh = scenes::floor_facing_z(1);
    for (V2f& uv : mesh.uvs)
        uv.x = 1 - uv.x; // mirrored
    const V3d normal = V3d(0.3, 0.4, 0.8).normalized();
    const MappedBake object(
        mesh, [&](double, double) { return normal; }, map_params(8, 8, 64), {}, "object");
    const MappedBake tangent(
        mesh, [&](double, double) { return V3d(-normal.x, normal.y, normal.z); }, map_params(8, 8, 64));
    for (int y = 0; y < 8; ++y)
        EXPECT_LT((object.at(2, y).normal - tangent.at(2, y).normal).length(), 1e-6);
}

TEST(NormalMapBake, AnyNumberOfThreadsGivesTheSameBits)
{
    const auto waves
        = [](double s, double t) { return V3d(0.3 * std::sin(40 * s), 0.3 * std::cos(30 * t), 1).normalized(); };
    const std::vector<Mesh> wall { scenes::quad(V3d(-0.5, -9, 0), V3d(-0.5, 9, 0), V3d(-0.5, 9, 9), V3d(-0.5, -9, 9)) };
    VismapParams params = map_params(80, 70, 16);
    for (const char* basis : { "vector", "sh", "mask", "cells" }) {
        params.basis = basis;
        const MappedBake one(scenes::floor_facing_z(1), waves, params, wall, "tangent", 1),
            three(scenes::floor_facing_z(1), waves, params, wall, "tangent", 3);
        EXPECT_TRUE(same_pixels(one.image(), three.image())) << basis;
    }
}

// A shallow wave: what its normal map makes of a plane is nearly what the wave itself sees.
TEST(NormalMapBake, ADisplacedSurfaceIsWhatItsNormalMapSays)
{
    const int cells = 128;
    const double height = 0.004, waves = 8; // slopes up to 0.1
    const double k = waves * M_PI;
    const auto slope = [&](double x) { return height * k * std::cos(k * x); };
    Mesh displaced;
    for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i) {
            const double x = 2.0 * i / cells - 1, y = 2.0 * j / cells - 1;
            displaced.positions.emplace_back(x, y, height * std::sin(k * x));
            displaced.normals.push_back(V3f(V3d(-slope(x), 0, 1).normalized()));
            displaced.uvs.emplace_back(float(i) / float(cells), float(j) / float(cells));
        }
    for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i) {
            const auto at = [&](int a, int b) { return uint32_t((j + b) * (cells + 1) + i + a); };
            displaced.triangles.push_back({ at(0, 0), at(1, 0), at(1, 1) });
            displaced.triangles.push_back({ at(0, 0), at(1, 1), at(0, 1) });
        }
    const VismapParams params = map_params(64, 4, 1024);
    const BakedMap truth(displaced, {}, params), plain(scenes::floor_facing_z(1), {}, params);
    const MappedBake mapped(
        scenes::floor_facing_z(1), [&](double s, double) { return V3d(-slope(2 * s - 1), 0, 1).normalized(); }, params);
    double without = 0, with = 0;
    for (int x = 4; x < 60; ++x) { // away from the wave's ends
        without += (V3d(plain.at(x, 2).direction) - V3d(truth.at(x, 2).direction)).length2();
        with += (mapped.at(x, 2).direction - V3d(truth.at(x, 2).direction)).length2();
        EXPECT_NEAR(mapped.at(x, 2).visibility, double(truth.at(x, 2).visibility), 0.04) << x;
    }
    EXPECT_LT(std::sqrt(with), 0.25 * std::sqrt(without));
}
