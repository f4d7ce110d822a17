// SPDX-License-Identifier: Apache-2.0
/// Which pixels no triangle and no strand can reach: what is behind the objects needs no ray.
#pragma once

#include <vmlight/frame/camera.h>
#include <vmlight/frame/frame_scene.h>

#include <cstdint>
#include <vector>

namespace vmlight {

class PixelCover
{
public:
    /// Project all triangles and strands of the scene. Errs on the side of cover: each has the pixels of its bounding
    /// rectangle, and one that is partly behind the camera has them all.
    ///
    /// @param reach    how far a pixel's filter reaches beyond the pixel
    PixelCover(const FrameScene& scene, const Camera& camera, const Size& picture, double reach, int nthreads);

    /// Whether nothing can be seen through the pixel.
    bool is_empty(int x, int y) const { return at(x, y) == 0; }
    /// Whether a strand can be, which may be thinner than samples are apart.
    bool has_strand(int x, int y) const { return at(x, y) >= kStrand; }
    /// The same for all pixels of a rectangle.
    bool is_empty(int left, int top, int width, int height) const;

private:
    enum : uint8_t
    {
        kTriangle = 1,
        kStrand = 2
    };
    uint8_t at(int x, int y) const { return m_covered[size_t(y) * size_t(m_width) + size_t(x)]; }

    int m_width;
    std::vector<uint8_t> m_covered; // not bits: threads write side by side
};

} // namespace vmlight
