// SPDX-License-Identifier: Apache-2.0
// A user's program: every public header, the installed OCIO config, and the library's answers where they are known.
#include <vmlight/cfem/cfem.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/math/latlong.h>
#include <vmlight/math/rotation.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imagebufalgo.h>

#include <cmath>
#include <cstdio>

namespace {

int failed(const char* what, const std::string& why)
{
    std::fprintf(stderr, "consumer: %s: %s\n", what, why.c_str());
    return 1;
}

} // namespace

int main()
{
    // A constant environment is its own filtered map, in whatever space.
    OIIO::ImageBuf environment(OIIO::ImageSpec(8, 4, 3, OIIO::TypeFloat)), cfem;
    OIIO::ImageBufAlgo::fill(environment, { 2.0f, 2.0f, 2.0f });
    std::string note, error;
    if (!vmlight::to_scene_linear(environment, "sky.hdr", { OCIO_CONFIG, "" }, note, error))
        return failed("to_scene_linear", error);
    if (!vmlight::make_cfem(cfem, environment))
        return failed("make_cfem", cfem.geterror());
    float light = cfem.getchannel(3, 2, 0, 1);
    if (std::abs(light - 2.0f) > 1e-4f)
        return failed("make_cfem", std::to_string(light) + " is not 2");

    // A quarter turn takes +z to +x.
    const Imath::V3d x = vmlight::rotate(vmlight::rotation_from_angles(0, 90, 0), Imath::V3d(0, 0, 1));
    if (x != Imath::V3d(1, 0, 0))
        return failed("rotation_from_angles", "a quarter turn is not exact");

    // An environment is no visibility map, and the library says so.
    std::array<int, 4> index;
    if (vmlight::find_vismap_channels(environment.spec(), index, error))
        return failed("find_vismap_channels", "takes an environment for a visibility map");
    vmlight::LightmapRecipe recipe;
    if (vmlight::read_recipe_text(recipe, "rotat = [1, 2, 3]", "x.lightmap", error))
        return failed("read_recipe_text", "takes a key that is none");
    if (vmlight::read_recipe(recipe, "x.lightmap?rotate=1,2,3", error))
        return failed("read_recipe", "takes a file that is none");
    if (vmlight::make_image(cfem, recipe))
        return failed("make_image", "makes a lightmap of nothing");
    std::printf("consumer: %s; %s\n", note.c_str(), error.c_str());
    return 0;
}
