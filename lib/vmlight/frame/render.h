// SPDX-License-Identifier: Apache-2.0
/// The renderer of frames: what a camera sees of lit objects. Their light is looked up, none is traced.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/base/progress.h>
#include <vmlight/frame/camera.h>
#include <vmlight/frame/frame_scene.h>
#include <vmlight/frame/layers.h>
#include <vmlight/frame/pixel_samples.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

struct RenderParams
{
    Size size { 1024, 1024 };
    int spp = 16;
    std::string filter = "blackman-harris";
    /// Which pixels get all samples. `edges`: those around which a surface ends, has a seam or is not opaque; the
    /// others are mixed from what is seen through their corners, with weights that have the variance of the filter.
    /// `all`: all of them. Measured: docs/frames.md.
    std::string sampling = "edges";
    std::vector<std::string> layers;

    template <class Visit> void visit(Visit&& field)
    {
        field("size", size, SizeRange { 16384, 1 },
              "Width and height of the picture in pixels; one number for a square");
        field("spp", spp, Range { 1, 4096 }, "Samples per pixel");
        field("filter", filter, pixel_filter_choices(), advanced("Pixel filter"));
        field("sampling", sampling,
              Choices {
                  { { "edges", "pixels inside a smooth surface are mixed from their corners: several times as fast" },
                    { "all", "every pixel gets all samples; sees what is thinner than a pixel everywhere" } } },
              advanced("Which pixels get all samples"));
        field("layers", layers, frame_layer_choices(), "Layers to write besides the colour, into an EXR");
    }
};

/// Render a frame.
///
/// @param dst      set to a float image of R, G, B, A, colour times alpha, then the channels of `params.layers` in the
///                 order of frame_layers(). Scene-linear, in the space of the scene's light, in its units. A is 1 where
///                 the background is visible
/// @param nthreads 0 means OIIO's default. The result is the same bits for every value.
/// @returns false, with the reason in `error`, if a texture cannot be read, memory runs out, or `progress` stopped the
///          work ("interrupted").
/// A surface is seen from both sides. Texture footprints are those of the pixel over the square root of the samples:
/// together the samples cover it. Where materials have alpha, up to 32 layers are seen one behind the other.
bool render_frame(OIIO::ImageBuf& dst, const FrameScene& scene, const Camera& camera, const RenderParams& params,
                  int nthreads, const Progress& progress, std::string& error);

} // namespace vmlight
