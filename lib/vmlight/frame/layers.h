// SPDX-License-Identifier: Apache-2.0
/// The layers of a frame besides its colour: one row of a table each.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/frame/frame_scene.h>
#include <vmlight/frame/surface_point.h>

#include <array>
#include <string>
#include <vector>

namespace vmlight {

constexpr int kMostLayerChannels = 4;
/// The last layer, of one channel of the same name.
constexpr const char* kCoverageLayer = "coverage";

/// What is known of the nearest point that a camera ray meets.
struct SeenPoint
{
    const FrameSurface* surface = nullptr;
    uint32_t triangle = 0;
    FramePoint point;
    TextureFootprint uv;
    Imath::C3f albedo { 1, 1, 1 }, light { 0, 0, 0 };
    /// Of an open strand: what it mirrors.
    Imath::C3f specular { 0, 0, 0 };
    /// V and B; 0 if the surface has none.
    std::array<float, 4> visibility {};
    double alpha = 1;
    Imath::V3d strand_normal { 0 }; ///< of a strand: across it, towards the camera
};

struct FrameLayer
{
    /// The word for --layers.
    const char *name, *meaning;
    /// Names of its channels.
    std::vector<std::string> channels;
    /// Mean of the samples, times alpha, as colour is; otherwise the value of the sample nearest to the pixel's centre:
    /// means of places are in no place.
    bool is_filtered;
    /// What it has where nothing is seen.
    float nothing;
    /// Whether it needs SeenPoint::visibility.
    bool needs_visibility;
    void (*value)(const SeenPoint& seen, float* dst);
};

const std::vector<FrameLayer>& frame_layers();
/// Their names, for a parameter.
ChoiceSet frame_layer_choices();

} // namespace vmlight
