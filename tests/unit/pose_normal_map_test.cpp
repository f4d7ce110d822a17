// SPDX-License-Identifier: Apache-2.0
// Poses of a mesh with a normal map: tangents are made of neighbours.
#include "pose_scenes.h"

#include <vmlight/vismap/normal_map.h>

#include <OpenImageIO/imagebufalgo.h>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

NormalMapPointer leaning_normals(const BakeScenePointer& scene, const VismapParams& params, float green)
{
    OIIO::ImageBuf image(OIIO::ImageSpec(4, 4, 3, OIIO::TypeFloat));
    const float rgb[3] { 0.8f, green, 0.9f };
    OIIO::ImageBufAlgo::fill(image, rgb);
    auto normals = std::make_shared<NormalMap>();
    std::vector<std::string> warnings;
    std::string error;
    EXPECT_TRUE(normals->decode(image, {}, params.size(), 1, warnings, error)) << error;
    normals->attach({ scene, &scene->mesh() });
    return normals;
}

} // namespace

TEST(PoseNormalMaps, TangentsTurnWithTheirNeighbours)
{
    // A flat sheet whose last column is sheared, under a ball that stands still.
    const VismapParams params = pose_params(64, 32);
    const auto sheet = [](double down) {
        Mesh mesh;
        add_sheet(
            mesh, 4, 1, [down](double u, double v) { return V3d(u, v - down * std::max(0.0, u - 0.75), 0); },
            V2f(0.01f, 0.01f), V2f(0.99f, 0.99f));
        for (const double far : { -2.0, 3.0 }) // the box around it stays
            add_quad(mesh, V3d(far, far, -1), V3d(far + 1e-3, far, -1), V3d(far + 1e-3, far + 1e-3, -1),
                     V3d(far, far + 1e-3, -1), V2f(0, 0), V2f(0.004f, 0.004f));
        for (V3f& normal : mesh.normals)
            normal = V3f(0, 0, 1);
        return scene_of(mesh, { placed(icosphere(1), 0.2, V3d(0.5, 0.5, 0.4)) }); // else it is open
    };
    const BakeScenePointer before = sheet(0), after = sheet(0.5);
    PoseSequence sequence(0);
    OIIO::ImageBuf base, kept, whole;
    const NormalMapPointer normals = leaning_normals(after, params, 0.5f);
    ASSERT_TRUE(sequence.bake(base, { before, params, 0, {}, 0, leaning_normals(before, params, 0.5f) }, "a", nullptr));
    ASSERT_TRUE(sequence.bake(kept, { after, params, 0, {}, 0, normals }, "b", nullptr));
    EXPECT_GT(sequence.last().kept, sequence.last().covered / 3);
    ASSERT_TRUE(make_vismap(whole, after, params, nullptr, 0, {}, 0, normals)) << whole.geterror();
    for (int x = 0; x < 46; ++x) // of triangles that stand still
        for (int c = 0; c < 4; ++c)
            ASSERT_EQ(kept.getchannel(x, 32, 0, c), whole.getchannel(x, 32, 0, c)) << x << " " << c;
}

TEST(PoseNormalMaps, AnotherNormalMapIsBakedWhole)
{
    const VismapParams params = pose_params(64, 16);
    const BakeScenePointer scene = scene_of(skin(0));
    OIIO::ImageBuf map, whole;
    PoseSequence sequence(0);
    const NormalMapPointer other = leaning_normals(scene, params, 0.7f);
    ASSERT_TRUE(sequence.bake(map, { scene, params, 0, {}, 0, leaning_normals(scene, params, 0.5f) }, "a", nullptr));
    ASSERT_TRUE(sequence.bake(map, { scene, params, 0, {}, 0, other }, "b", nullptr));
    EXPECT_EQ(sequence.last().why, "its normal map is another");
    ASSERT_TRUE(make_vismap(whole, scene, params, nullptr, 0, {}, 0, other)) << whole.geterror();
    for (int x = 0; x < 64; ++x)
        ASSERT_EQ(map.getchannel(x, 32, 0, 0), whole.getchannel(x, 32, 0, 0)) << x;
    ASSERT_TRUE(sequence.bake(map, { scene, params, 0, {}, 0, nullptr }, "c", nullptr));
    EXPECT_EQ(sequence.last().why, "its normal map is another");
}
