// SPDX-License-Identifier: Apache-2.0
// Any bytes as images, of any size, channels, windows, metadata and pixels: what makes light of them refuses them in
// one line, or makes finite pixels of them, the same ones on two threads.
//   map_fuzz -max_total_time=60 NEW_CORPUS tests/fuzz/map_corpus
#include "image_of_bytes.h"
#include "law.h"

#include <vmlight/cfem/radiance.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/lightmap/lightmap.h>

using namespace vmlight;
using namespace vmlight::fuzz;

namespace {

CfemParams cfem_params_of(Bytes& bytes)
{
    CfemParams params;
    params.filter = bytes.flag() ? "sh" : "exact";
    params.order = int(1 + bytes.below(8));
    params.resolution = { int(1 + bytes.below(9)), int(1 + bytes.below(9)) };
    params.sanitize = bytes.flag();
    return params;
}

LightmapParams lightmap_params_of(Bytes& bytes)
{
    LightmapParams params;
    params.model = bytes.choice(std::array<const char*, 7> { "auto", "ao", "paper", "lobe", "sh", "mask", "cells" });
    const auto numbers = [&](size_t count) {
        std::vector<double> list(bytes.byte() < 192 ? 0 : count);
        std::generate(list.begin(), list.end(), [&] { return bytes.number(); });
        return list;
    };
    params.rotate = numbers(3);
    params.matrix = numbers(9);
    params.quaternion = numbers(4);
    params.env_rotate = numbers(3);
    params.exposure = bytes.number();
    return params;
}

void require_light(bool made, const std::vector<OIIO::ImageBuf>& images, const std::string& error)
{
    if (!made)
        return require_reason(error);
    require(images.size() == kStackImages, "a stack is whole", std::to_string(images.size()));
    for (const OIIO::ImageBuf& image : images)
        require_made(true, image);
}

// What shading reads: a stack, a CFEM, the environment at its size, or an image that may be anything.
std::vector<OIIO::ImageBuf> light_of(Bytes& bytes, const OIIO::ImageBuf& env)
{
    const CfemParams params = cfem_params_of(bytes);
    std::vector<OIIO::ImageBuf> light(1);
    std::string error;
    switch (bytes.below(4)) {
    case 0:
        require_light(make_cfem_stack(light, env, params, error), light, error);
        break;
    case 1: {
        OIIO::ImageBuf again;
        const bool made = make_cfem(light[0], env, params, 1);
        require_made(made, light[0]);
        if (made)
            require(make_cfem(again, env, params, 2) && pixels_of(again) == pixels_of(light[0]),
                    "two threads filter what one does", again.geterror());
        break;
    }
    case 2: {
        const bool made = make_radiance(light[0], env, params, error);
        made ? require_made(made, light[0]) : require_reason(error);
        break;
    }
    default:
        light[0] = env;
    }
    return light;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    Bytes bytes(data, size);
    const uint8_t has = bytes.byte();
    const LightmapParams params = lightmap_params_of(bytes);
    const OIIO::ImageBuf env = image_of(bytes, "env");
    const std::vector<OIIO::ImageBuf> light = light_of(bytes, env);
    if (light.empty())
        return 0;
    const OIIO::ImageBuf vismap = image_of(bytes, "vismap");
    const OIIO::ImageBuf albedo = has & 1 ? image_of(bytes, "albedo") : OIIO::ImageBuf();
    OIIO::ImageBuf lightmap, again;
    const OIIO::ImageBuf* with = has & 1 ? &albedo : nullptr;
    const bool made = make_lightmap(lightmap, vismap, light, params, with, 1);
    require_made(made, lightmap);
    if (made)
        require(make_lightmap(again, vismap, light, params, with, 2) && pixels_of(again) == pixels_of(lightmap),
                "two threads shade what one does", again.geterror());
    return 0;
}
