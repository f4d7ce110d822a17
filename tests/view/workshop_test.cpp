// SPDX-License-Identifier: Apache-2.0
// Work that vmview does beside the window: jobs, ever finer maps, files that are dropped.
#include "view_test.h"

#include "strand_files.h"
#include "temporary_folder.h"
#include "vmview/scene/job.h"
#include "vmview/ui/workshop.h"

#include <vmlight/vismap/baker.h>

#include <OpenImageIO/imagebuf.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

using namespace vmlight;
using namespace vmlight::view;
using namespace vmlight::strand_files;

namespace {

template <class Ready> bool wait_until(Ready&& ready)
{
    for (int i = 0; i < 6000; ++i) {
        if (ready())
            return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
}

} // namespace

TEST(Job, StopsAtOnceAndDropsItsResult)
{
    Job<int> job;
    std::atomic<bool> has_stopped { false };
    job.start([&](const Job<int>::Post& post, const Progress& go_on) {
        post({ 1, "", false });
        while (go_on(0.5))
            std::this_thread::yield();
        has_stopped = true;
        post({ 2, "", true });
    });
    ASSERT_TRUE(wait_until([&] { return job.done() == 0.5; }));
    job.stop();
    EXPECT_TRUE(has_stopped);
    EXPECT_FALSE(job.take());
    EXPECT_FALSE(job.is_busy());
}

TEST(Job, ReportsExceptions)
{
    Job<int> job;
    job.start([](const Job<int>::Post&, const Progress&) { throw std::runtime_error("out of luck"); });
    std::optional<JobResult<int>> result;
    ASSERT_TRUE(wait_until([&] {
        const bool is_busy = job.is_busy();
        result = job.take();
        EXPECT_TRUE(is_busy) << "until the result is taken";
        return result.has_value();
    }));
    EXPECT_EQ(result->error, "out of luck");
    EXPECT_TRUE(wait_until([&] { return !job.is_busy(); }));
}

// Maps of 1, 4, ... rays, the last one with as many as were asked for, and bit for bit the bake of the executable.
TEST(Workshop, BakesEverFinerMaps)
{
    Request request;
    request.mesh.mesh = data_path("cases/box.obj");
    request.mesh.vismap_params.resolution = { 32, 32 };
    request.mesh.vismap_params.samples = 20;
    Workshop workshop(request, {});
    MeshPointer mesh;
    MapPointer map;
    std::string problem;
    ASSERT_TRUE(wait_until([&] { return workshop.take_mesh(mesh, problem); }) && problem.empty()) << problem;
    workshop.bake_for("paper");
    int last = 0;
    ASSERT_TRUE(wait_until([&] {
        if (workshop.take_map(map, problem)) {
            EXPECT_GT(map->samples, last);
            last = map->samples;
        }
        return last == 20;
    }));
    VismapParams params = bake_params(mesh->recipe.vismap_params, "paper");
    OIIO::ImageBuf baked;
    ASSERT_TRUE(make_vismap(baked, mesh->scene, params, nullptr, 0, {}));
    EXPECT_EQ(std::memcmp(baked.localpixels(), map->image.localpixels(), baked.spec().image_bytes()), 0);
    // A model that reads more: baked again.
    workshop.bake_for("paper");
    EXPECT_TRUE(workshop.is_baked());
    workshop.bake_for("sh");
    EXPECT_FALSE(workshop.is_baked());
    workshop.stop();
}

// A map that is stored, and ever finer ones of what is beside it; what is dropped takes their place.
TEST(Workshop, HasStrandsBesideTheMesh)
{
    const TemporaryFolder folder;
    Request request;
    request.mesh.mesh = data_path("cases/box.obj");
    request.mesh.vismap_params.samples = 5;
    request.mesh.strand_params.radius = "0.02";
    request.view.object = { folder.write("curls.tfx", tfx_of(curls(5, 1))) };
    for (const bool is_stored : { true, false }) {
        if (is_stored) {
            request.vismap = folder / "box_vismap.exr";
            ASSERT_TRUE(full_map(data_mesh("cases/box.obj"), { 16, 16 }, 4).write(request.vismap));
        } else {
            request.vismap.clear();
            request.mesh.vismap_params.resolution = { 16, 16 };
        }
        Workshop workshop(request, {});
        MeshPointer mesh;
        MapPointer map;
        std::string problem, error;
        ASSERT_TRUE(wait_until([&] { return workshop.take_mesh(mesh, problem); })) << problem;
        EXPECT_EQ(mesh->beside.size(), 1u);
        workshop.bake_for("paper");
        int last = 0;
        ASSERT_TRUE(wait_until([&] {
            if (workshop.take_map(map, problem) && map->beside.size() == 1) {
                EXPECT_GT(map->beside[0]->samples, last);
                last = map->beside[0]->samples;
            }
            return last == 5;
        })) << problem;
        EXPECT_EQ(map->path, request.vismap);
        ASSERT_TRUE(workshop.open(request.view.object[0], error)) << error;
        ASSERT_TRUE(wait_until([&] { return workshop.take_mesh(mesh, problem); })) << problem;
        EXPECT_TRUE(mesh->is_strands() && mesh->beside.empty());
        workshop.bake_for("paper");
        ASSERT_TRUE(wait_until([&] { return workshop.take_map(map, problem); })) << problem;
        EXPECT_TRUE(map->beside.empty());
        workshop.stop();
    }
}

// They are shown; what is opened is used nevertheless.
TEST(Workshop, WarnsOfAMapOfAnotherMesh)
{
    const TemporaryFolder folder;
    Request request;
    request.mesh.mesh = data_path("cases/box.obj");
    request.vismap = folder / "spot_vismap.exr";
    ASSERT_TRUE(full_map(data_mesh("spot.obj"), { 16, 16 }, 4).write(request.vismap));
    Workshop workshop(request, {});
    MeshPointer mesh;
    MapPointer map;
    std::string problem;
    ASSERT_TRUE(wait_until([&] { return workshop.take_mesh(mesh, problem); })) << problem;
    ASSERT_TRUE(wait_until([&] { return workshop.take_map(map, problem); })) << problem;
    const std::vector<std::string> warnings = workshop.take_warnings();
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("spot_vismap.exr\": was baked from another mesh than \""), std::string::npos)
        << warnings[0];
    EXPECT_TRUE(workshop.take_warnings().empty());
}

TEST(Workshop, OpensWhatIsDropped)
{
    const TemporaryFolder folder;
    Request request;
    Workshop workshop(request, {});
    MeshPointer mesh;
    MapPointer map;
    LightPointer light;
    std::string problem, error;
    // A map that comes before its mesh waits for it.
    const Mesh spot = data_mesh("spot.obj");
    const std::string path = folder / "spot_vismap.exr";
    ASSERT_TRUE(full_map(spot, { 32, 32 }, 4).write(path));
    ASSERT_TRUE(workshop.open(path, error)) << error;
    ASSERT_TRUE(workshop.open(data_path("studio_small_03.hdr"), error)) << error;
    EXPECT_TRUE(wait_until([&] { return workshop.take_light(light, problem); })) << problem;
    ASSERT_TRUE(workshop.open(data_path("spot.obj"), error)) << error;
    EXPECT_TRUE(wait_until([&] { return workshop.take_mesh(mesh, problem); })) << problem;
    EXPECT_TRUE(wait_until([&] { return workshop.take_map(map, problem); })) << problem;
    EXPECT_EQ(map ? map->path : "", path);
    EXPECT_FALSE(workshop.open(data_path("README.md"), error));
    EXPECT_NE(error, "");
    EXPECT_EQ(kind_of_file(path, error), AssetKind::map);
    EXPECT_EQ(kind_of_file(data_path("spot.obj"), error), AssetKind::mesh);
    EXPECT_EQ(kind_of_file(data_path("studio_small_03.hdr"), error), AssetKind::light);
    for (const char* name : { "a.stl", "a.abc", "a.dae" })
        EXPECT_EQ(kind_of_file(folder / name, error), AssetKind::mesh) << name;
    OIIO::ImageBuf lit(OIIO::ImageSpec(4, 4, 3, OIIO::TypeFloat));
    lit.specmod().attribute("vmlight:stage", "lightmap");
    ASSERT_TRUE(lit.write(folder / "lit.exr"));
    error.clear();
    EXPECT_EQ(kind_of_file(folder / "lit.exr", error), AssetKind::none);
    EXPECT_NE(error.find("a lit texture; open its mesh"), std::string::npos) << error;
}
