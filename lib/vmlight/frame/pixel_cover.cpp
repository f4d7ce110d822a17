// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/pixel_cover.h>

#include <vmlight/base/parallel.h>
#include <vmlight/mesh/strands.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace vmlight {
namespace {

using Imath::V2d;
using Imath::V3d;

constexpr int64_t kBlock = 4096; // triangles

struct Rectangle
{
    V2d low { std::numeric_limits<double>::infinity() }, high { -std::numeric_limits<double>::infinity() };

    void add(const V2d& p)
    {
        low.x = std::min(low.x, p.x), low.y = std::min(low.y, p.y);
        high.x = std::max(high.x, p.x), high.y = std::max(high.y, p.y);
    }
};

// Where a point is in the picture, in pixels. False if it is not in front of the camera.
bool project(V2d& dst, const V3d& point, const Camera& camera, const Size& picture, double nearest)
{
    const V3d q = point - camera.position;
    const double depth = camera.is_orthographic ? 1 : q.dot(camera.forward);
    if (!(depth > nearest))
        return false;
    dst.x = (q.dot(camera.right) / (depth * camera.half_width) + 1) * 0.5 * picture.width;
    dst.y = (1 - q.dot(camera.up) / (depth * camera.half_height)) * 0.5 * picture.height;
    return true;
}

} // namespace

PixelCover::PixelCover(const FrameScene& scene, const Camera& camera, const Size& picture, double reach, int nthreads)
    : m_width(picture.width)
    , m_covered(size_t(picture.width) * size_t(picture.height), 0)
{
    // A byte of several threads.
    const auto mark = [&](const Rectangle& area, uint8_t what) {
        const auto first = [&](double x, int n) { return int(std::clamp(std::floor(x - reach), 0.0, double(n))); };
        const auto end = [&](double x, int n) { return int(std::clamp(std::floor(x + reach) + 1, 0.0, double(n))); };
        const int left = first(area.low.x, picture.width), right = end(area.high.x, picture.width);
        const int bottom = end(area.high.y, picture.height);
        for (int y = first(area.low.y, picture.height); y < bottom; ++y)
            for (int x = left; x < right; ++x)
                __atomic_fetch_or(&m_covered[size_t(y) * size_t(m_width) + size_t(x)], what, __ATOMIC_RELAXED);
    };
    std::atomic<bool> is_around_camera { false };
    const double nearest = camera.is_orthographic ? 0 : 1e-6 * scene.radius;
    for (const FrameSurface& surface : scene.surfaces) {
        const Mesh& mesh = *surface.mesh;
        const int64_t count = int64_t(mesh.triangles.size());
        parallel_items((count + kBlock - 1) / kBlock, nthreads, [&](int64_t block, int) {
            for (int64_t t = block * kBlock; t < std::min(count, (block + 1) * kBlock) && !is_around_camera; ++t) {
                Rectangle area;
                int in_front = 0;
                for (const uint32_t vertex : mesh.triangles[size_t(t)]) {
                    V2d at;
                    if (!project(at, mesh.positions[vertex], camera, picture, nearest))
                        continue;
                    area.add(at);
                    ++in_front;
                }
                if (in_front == 3)
                    mark(area, kTriangle);
                else if (in_front > 0)
                    is_around_camera = true;
            }
        });
        if (!mesh.strands)
            continue;
        const Strands& strands = *mesh.strands;
        parallel_items(int64_t(strands.count()), nthreads, [&](int64_t strand, int) {
            // The curve is within the boxes around neighbouring points, each as wide as the strand.
            const double radius = thickest_radius(strands, size_t(strand));
            Rectangle last;
            for (size_t p = strands.begin(size_t(strand)); p < strands.end(size_t(strand)) && !is_around_camera; ++p) {
                Rectangle own;
                for (int corner = 0; corner < 8; ++corner) {
                    const V3d offset(corner & 1 ? radius : -radius, corner & 2 ? radius : -radius,
                                     corner & 4 ? radius : -radius);
                    V2d at(0);
                    if (!project(at, strands.points[p] + offset, camera, picture, nearest))
                        is_around_camera = true;
                    own.add(at);
                }
                Rectangle both = last;
                both.add(own.low);
                both.add(own.high);
                mark(both, kStrand);
                last = own;
            }
        });
    }
    if (is_around_camera)
        std::fill(m_covered.begin(), m_covered.end(), uint8_t(kTriangle | kStrand));
}

bool PixelCover::is_empty(int left, int top, int width, int height) const
{
    for (int y = top; y < top + height; ++y)
        for (int x = left; x < left + width; ++x)
            if (!is_empty(x, y))
                return false;
    return true;
}

} // namespace vmlight
