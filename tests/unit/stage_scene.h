// SPDX-License-Identifier: Apache-2.0
/// A folder of recipes and what they read, opened through OIIO as a host does.
#pragma once

#include "temporary_folder.h"

#include <vmlight/base/work_counts.h>
#include <vmlight/cfem/cfem.h>
#include <vmlight/image/color.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/stage/reader.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace vmlight::stage_scene {

inline void declare_formats()
{
    static const bool done = [] {
        static const char* vismap[] = { "vismap", nullptr };
        static const char* cfem[] = { "cfem", nullptr };
        static const char* lightmap[] = { "lightmap", nullptr };
        const auto declare = [](OIIO::ImageInput::Creator create, const char** extensions) {
            OIIO::declare_imageio_format(extensions[0], create, extensions, nullptr, nullptr, "vmlight");
        };
        declare([]() -> OIIO::ImageInput* { return new StageInput("vismap"); }, vismap);
        declare([]() -> OIIO::ImageInput* { return new StageInput("cfem"); }, cfem);
        declare([]() -> OIIO::ImageInput* { return new StageInput("lightmap"); }, lightmap);
        return true;
    }();
    (void)done;
}

/// spot.obj, studio.exr, hero.vismap, studio.cfem, hero.lightmap.
class Folder : public TemporaryFolder
{
public:
    Folder()
    {
        declare_formats();
        std::filesystem::copy(VMLIGHT_TEST_DATA "/spot.obj", *this / "spot.obj");
        OIIO::ImageBuf sky(OIIO::ImageSpec(32, 16, 3, OIIO::TypeFloat));
        OIIO::ImageBufAlgo::noise(sky, "uniform", 0.0f, 4.0f, false, 7);
        EXPECT_TRUE(sky.write(*this / "studio.exr")) << sky.geterror();
        write("hero.vismap", "mesh = \"spot.obj\"\nresolution = [200, 150]\nsamples = 4\n");
        write("studio.cfem", "environment = \"studio.exr\"\nresolution = 32\n");
        write("hero.lightmap", "vismap = \"hero.vismap\"\ncfem = \"studio.cfem\"\nrotate = [0, 30, 0]\n");
    }

    // What the executables make of them.
    OIIO::ImageBuf vismap() const
    {
        Mesh mesh;
        std::string error;
        VismapParams params;
        params.resolution = { 200, 150 };
        params.samples = 4;
        OIIO::ImageBuf image;
        EXPECT_TRUE(read_mesh(mesh, *this / "spot.obj", {}, error)) << error;
        EXPECT_TRUE(make_vismap(image, mesh, {}, params)) << image.geterror();
        append_params(image.specmod(), MeshParams {});
        for (const char* name : { "frame", "fps", "terrain", "height_scale" }) // none is given
            image.specmod().erase_attribute(metadata_name(name));
        return image;
    }
    OIIO::ImageBuf cfem() const
    {
        OIIO::ImageBuf sky(*this / "studio.exr"), image;
        std::string note, error;
        CfemParams params;
        params.resolution = { 32, 16 };
        EXPECT_TRUE(sky.read(0, 0, true, OIIO::TypeFloat)) << sky.geterror();
        EXPECT_TRUE(to_scene_linear(sky, *this / "studio.exr", {}, note, error)) << error;
        EXPECT_TRUE(make_cfem(image, sky, params)) << image.geterror();
        record_environment(image.specmod(), "elsewhere/studio.exr");
        return image;
    }
};

inline std::vector<float> all_pixels(OIIO::ImageInput& input)
{
    const OIIO::ImageSpec spec = input.spec();
    std::vector<float> pixels(size_t(spec.image_pixels()) * spec.nchannels, -1.0f);
    EXPECT_TRUE(input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, pixels.data())) << input.geterror();
    return pixels;
}

inline std::vector<float> all_pixels(const OIIO::ImageBuf& image)
{
    std::vector<float> pixels(size_t(image.spec().image_pixels()) * image.nchannels(), -2.0f);
    EXPECT_TRUE(image.get_pixels(image.roi(), OIIO::TypeFloat, pixels.data())) << image.geterror();
    return pixels;
}

/// What readers did so far.
struct Work
{
    int64_t meshes_read = work_counts().meshes_read, scenes_built = work_counts().scenes_built;
    int64_t tiles_baked = work_counts().tiles_baked;
    int64_t cfems_made = work_counts().cfems_made, tiles_shaded = work_counts().tiles_shaded;

    static Work none() { return Work() - Work(); }
    Work operator-(const Work& other) const
    {
        Work work;
        work.meshes_read = meshes_read - other.meshes_read;
        work.scenes_built = scenes_built - other.scenes_built;
        work.tiles_baked = tiles_baked - other.tiles_baked;
        work.cfems_made = cfems_made - other.cfems_made;
        work.tiles_shaded = tiles_shaded - other.tiles_shaded;
        return work;
    }
    bool operator==(const Work& other) const
    {
        return meshes_read == other.meshes_read && scenes_built == other.scenes_built
            && tiles_baked == other.tiles_baked && cfems_made == other.cfems_made && tiles_shaded == other.tiles_shaded;
    }
};

} // namespace vmlight::stage_scene
