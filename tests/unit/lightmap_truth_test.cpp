// SPDX-License-Identifier: Apache-2.0
// The models against ray tracing: a mesh on the ground, lit by photographed skies.
#include "scenes.h"
#include "stack_maps.h"

#include <vmlight/base/oiio_compat.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/trace/occluder.h>
#include <vmlight/trace/surface.h>
#include <vmlight/uv/raster.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imagebufalgo.h>

#include <limits>

using namespace vmlight;
using namespace scene;

namespace {

constexpr int kTruthSide = 40, kEnvironmentWidth = 128;

// Of each texel of the mesh: (1/pi) Int L vis max(0, n.w) dw, one ray to each pixel of the environment.
class TracedTruth
{
public:
    TracedTruth(const Mesh& mesh, const Mesh& ground)
        : m_frame(SceneFrame::around(mesh))
        , m_surface(mesh, m_frame)
        , m_cover(std::make_unique<TileCover>())
        , m_fan(kEnvironmentWidth * kEnvironmentWidth / 2)
    {
        std::string error;
        EXPECT_TRUE(m_occluder.build({ &mesh, &ground }, m_frame, 1, error)) << error;
        UvRaster(mesh, kTruthSide, kTruthSide).cover(0, *m_cover);
        const int width = kEnvironmentWidth, height = width / 2;
        for (int i = 0; i < width * height; ++i) {
            m_directions.push_back(V3f(latlong::direction((i % width + 0.5) / width, (i / width + 0.5) / height)));
            m_solid_angles.push_back(latlong::row_solid_angle(i / width, height) / width);
        }
    }
    void set_environment(const ImageBuf& environment)
    {
        m_green.clear();
        for (int y = 0; y < kEnvironmentWidth / 2; ++y)
            for (int x = 0; x < kEnvironmentWidth; ++x)
                m_green.push_back(environment.getchannel(x, y, 0, 1));
    }
    bool covers(int x, int y) const { return triangle(x, y) != TileCover::kNone; }
    double light(int x, int y)
    {
        const size_t texel = size_t(y * kTileSize + x);
        const SurfacePoint point = m_surface.at(triangle(x, y), m_cover->weight1[texel], m_cover->weight2[texel]);
        for (size_t i = 0; i < m_directions.size(); ++i) {
            const V3f& w = m_directions[i];
            m_fan.x[i] = w.x, m_fan.y[i] = w.y, m_fan.z[i] = w.z;
            const uint8_t bit = uint8_t(1 << i % 8);
            const bool front = w.dot(point.normal) > 0 && w.dot(point.geometric_normal) > 0;
            m_fan.lanes[i / 8] = uint8_t((m_fan.lanes[i / 8] & ~bit) | (front ? bit : 0));
        }
        m_occluder.clear_blocked(m_fan, point.origin, std::numeric_limits<float>::infinity());
        double sum = 0;
        for (size_t i = 0; i < m_directions.size(); ++i)
            if (m_fan.lanes[i / 8] >> i % 8 & 1)
                sum += m_green[i] * m_directions[i].dot(point.normal) * m_solid_angles[i];
        return sum / latlong::pi;
    }

private:
    uint32_t triangle(int x, int y) const { return m_cover->triangle[size_t(y * kTileSize + x)]; }

    SceneFrame m_frame;
    Surface m_surface;
    Occluder m_occluder;
    std::unique_ptr<TileCover> m_cover;
    RayFan m_fan;
    std::vector<V3f> m_directions; // to the pixels of the environment
    std::vector<double> m_solid_angles;
    std::vector<float> m_green;
};

} // namespace

TEST(LightmapTruth, EachModelIsCloserToRayTracingThanTheOneBefore)
{
    Mesh mesh;
    std::string error;
    ASSERT_TRUE(read_mesh(mesh, VMLIGHT_TEST_DATA "/spot.obj", {}, error)) << error;
    double low = 1e9;
    for (const V3d& p : mesh.positions)
        low = std::min(low, p.y);
    const Mesh ground = scenes::quad({ -9, low, 9 }, { 9, low, 9 }, { 9, low, -9 }, { -9, low, -9 });
    VismapParams bake;
    bake.resolution = { kTruthSide, kTruthSide };
    bake.samples = 1024;
    bake.margin = 0;
    bake.channels = { "normal" };
    const char* const models[] = { "ao", "paper", "lobe", "sh", "mask", "cells" };
    constexpr int kModels = 6;
    ImageBuf vm[kModels];
    for (int m = 0; m < kModels; ++m) {
        bake.basis = m < 3 ? "vector" : models[m];
        ASSERT_TRUE(make_vismap(vm[m], mesh, { ground }, bake)) << vm[m].geterror();
    }

    TracedTruth truth(mesh, ground);
    double error_of[kModels] = {};
    for (const std::string name : { "studio_small_03.hdr", "kloppenheim_05.hdr" }) {
        const ImageBuf whole(std::string(VMLIGHT_TEST_DATA "/") + name);
        ImageBuf sky;
        oiio::resize(sky, whole, OIIO::ROI(0, kEnvironmentWidth, 0, kEnvironmentWidth / 2, 0, 1, 0, 3), 0, "box");
        const std::vector<ImageBuf> stack = filtered_stack(sky, 128);
        truth.set_environment(sky);
        ImageBuf image[kModels];
        for (int m = 0; m < kModels; ++m)
            image[m] = lit(vm[m], stack, model(models[m]));
        double mean = 0, square[kModels] = {};
        int count = 0;
        for (int y = 0; y < kTruthSide; ++y)
            for (int x = 0; x < kTruthSide; ++x) {
                if (!truth.covers(x, y))
                    continue;
                const double light = truth.light(x, y);
                mean += light;
                for (int m = 0; m < kModels; ++m)
                    square[m] += std::pow(color(image[m], x, y).y - light, 2);
                ++count;
            }
        for (int m = 0; m < kModels; ++m) {
            const double error = std::sqrt(square[m] * count) / mean;
            RecordProperty(models[m] + ("_" + name), std::to_string(error));
            error_of[m] += error;
        }
    }
    EXPECT_LT(error_of[1], error_of[0]) << "paper against ao";
    EXPECT_LT(error_of[2], 0.8 * error_of[1]) << "lobe against paper";
    EXPECT_LT(error_of[3], 0.55 * error_of[1]) << "sh against paper";
    for (int m = 4; m < kModels; ++m)
        EXPECT_LT(error_of[m], 0.4 * error_of[1]) << models[m] << " against paper";
}
