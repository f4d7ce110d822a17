// SPDX-License-Identifier: Apache-2.0
/// Maps of random meshes and parameters, and the comparison of whole maps.
#pragma once

#include "scenes.h"

#include <vmlight/base/tile_size.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/vismap/map_rows.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imagebuf.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace vmlight {

inline VismapParams part_params(int width, int height)
{
    VismapParams params;
    params.resolution = { width, height };
    params.samples = 4;
    return params;
}

inline BakeScenePointer part_scene(const Mesh& mesh, const std::vector<Mesh>& occluders = {})
{
    auto scene = std::make_shared<BakeScene>();
    std::string error;
    EXPECT_TRUE(scene->build(std::make_shared<Mesh>(mesh), occluders, 0, error)) << error;
    return scene;
}

inline std::map<std::string, std::string> metadata_texts(const OIIO::ImageSpec& spec)
{
    std::map<std::string, std::string> found;
    for (const OIIO::ParamValue& attribute : spec.extra_attribs)
        found[attribute.name().string()] = std::string(attribute.type().c_str()) + " " + attribute.get_string();
    return found;
}

inline void expect_same_map(const OIIO::ImageBuf& joined, const OIIO::ImageBuf& whole)
{
    EXPECT_EQ(joined.spec().channelnames, whole.spec().channelnames);
    EXPECT_EQ(metadata_texts(joined.spec()), metadata_texts(whole.spec()));
    ASSERT_EQ(OIIO::get_roi(joined.spec()), OIIO::get_roi(whole.spec()));
    ASSERT_EQ(OIIO::get_roi_full(joined.spec()), OIIO::get_roi_full(whole.spec()));
    EXPECT_EQ(joined.spec().tile_width, whole.spec().tile_width);
    EXPECT_EQ(std::memcmp(joined.localpixels(), whole.localpixels(), size_t(whole.spec().image_bytes())), 0);
}

/// Puts a map together that passes from the top down.
inline MapRows rows_into(OIIO::ImageBuf& dst)
{
    auto next = std::make_shared<int>(0);
    return {
        [&dst](OIIO::ImageSpec& spec, std::string&) {
            dst.reset(spec, OIIO::InitializePixels::Yes);
            return true;
        },
        [&dst, next](int ybegin, int yend, const float* texels, std::string&) {
            const OIIO::ImageSpec& spec = dst.spec();
            EXPECT_EQ(ybegin, *next);
            EXPECT_TRUE(yend == spec.height || yend % kTileSize == 0);
            *next = yend;
            return dst.set_pixels({ 0, spec.width, ybegin, yend, 0, 1, 0, spec.nchannels }, OIIO::TypeFloat, texels);
        }
    };
}

inline Mesh random_mesh(std::mt19937& random)
{
    const auto number = [&](int least, int most) { return std::uniform_int_distribution<int>(least, most)(random); };
    switch (number(0, 2)) {
    case 0:
        return scenes::box(Imath::V3d(-1), Imath::V3d(1, number(1, 5), 2), number(0, 1) == 1);
    case 1:
        return scenes::sphere(Imath::V3d(0), 1, number(3, 9), number(0, 1) == 1);
    default:
        Mesh mesh;
        mesh.name = "soup";
        std::uniform_real_distribution<float> any(0, 1);
        for (int i = number(1, 12); i > 0; --i) {
            const Imath::V2f low(any(random), any(random));
            scenes::add_quad(mesh, Imath::V3d(any(random), any(random), 0), Imath::V3d(any(random), 0, any(random)),
                             Imath::V3d(1, any(random), any(random)), Imath::V3d(0, 1, any(random)), low,
                             low + Imath::V2f(.3f, .2f));
        }
        return mesh;
    }
}

// Whatever does not contradict the rest.
inline VismapParams random_params(std::mt19937& random)
{
    const auto number = [&](int least, int most) { return std::uniform_int_distribution<int>(least, most)(random); };
    VismapParams params = part_params(number(1, 300), number(1, 300));
    params.samples = number(2, 9);
    params.seed = number(0, 3);
    params.margin = std::array { 0, 3, 16, 70, -1 }[size_t(number(0, 4))];
    params.basis = std::array { "vector", "vector", "sh", "mask", "cells" }[size_t(number(0, 4))];
    params.order = 3;
    params.ground = number(0, 3) == 0;
    for (const char* channel : { "normal", "coverage", "error" })
        if (number(0, 2) == 0)
            params.channels.emplace_back(channel);
    if (number(0, 3) == 0)
        params.sun_directions = "0,1,0.2,3";
    if (params.basis == "vector" || params.basis == "sh")
        params.reconstruct = number(0, 1) ? "auto" : "off";
    if (number(0, 5) == 0)
        params.target_error = 0.1;
    return params;
}

} // namespace vmlight
