// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/shape.h>

#include <vmlight/base/format.h>
#include <vmlight/base/parallel_blocks.h>
#include <vmlight/base/params.h>
#include <vmlight/base/text.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vmlight {
namespace {

using Imath::V2d;
using Imath::V3d;

// What two texts of one mesh may differ by. Programs write positions and UVs with six digits, normals with four.
constexpr double kRounding = 1e-5; // by the size of the mesh
constexpr double kFarRounding = 1e-6; // by the distance from the origin
constexpr double kAreaRounding = 1e-4; // thin triangles change more than the mesh
constexpr double kNormalRounding = 1e-4;

// In the order of the text: the count of triangles; radius; centre; area by the square of the radius; and means over
// the surface, positions from the centre and by the radius: x^2, y^2, z^2, u, v, ux, uy, uz, vx, vy, vz, those with the
// shading normal n: n, n.p and n.face.
constexpr size_t kRadius = 1, kCentre = 2, kArea = 5, kFirstMean = 6, kFirstOfNormals = 17, kNumbers = 22;
using ShapeNumbers = std::array<double, kNumbers>;

struct ShapeSums
{
    double area = 0;
    V3d p { 0 }, pp { 0 }, up { 0 }, vp { 0 }, n { 0 };
    V2d uv { 0 };
    double np = 0, nf = 0;

    void add(const ShapeSums& other, double weight = 1)
    {
        area += weight * other.area;
        p += weight * other.p;
        pp += weight * other.pp;
        up += weight * other.up;
        vp += weight * other.vp;
        n += weight * other.n;
        uv += weight * other.uv;
        np += weight * other.np;
        nf += weight * other.nf;
    }
};

ShapeSums sums_of(const Mesh& mesh, const V3d& origin, size_t begin, size_t end)
{
    ShapeSums sums;
    for (size_t t = begin; t < end; ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const V3d pa = mesh.positions[a], pb = mesh.positions[b], pc = mesh.positions[c];
        const V3d face = (pb - pa).cross(pc - pa);
        const double twice = face.length();
        if (!(twice > 0))
            continue;
        V2d uv(0);
        for (const uint32_t v : { a, b, c })
            uv += has_uv(mesh, v) ? V2d(mesh.uvs[v]) / 3 : V2d(0);
        const V3d p = (pa - origin + (pb - origin) + (pc - origin)) / 3;
        const V3d n = V3d(mesh.normals[a] + mesh.normals[b] + mesh.normals[c]) / 3;
        sums.add({ 1, p, p * p, uv.x * p, uv.y * p, n, uv, n.dot(p), n.dot(face) / twice }, twice / 2);
    }
    return sums;
}

double tolerance(const ShapeNumbers& numbers, size_t i)
{
    const double size = kRounding * numbers[kRadius];
    if (i == kRadius)
        return size;
    if (i >= kCentre && i < kArea)
        return size + kFarRounding * V3d(numbers[kCentre], numbers[kCentre + 1], numbers[kCentre + 2]).length();
    if (i == kArea)
        return kAreaRounding * numbers[kArea];
    if (i >= kFirstOfNormals)
        return kNormalRounding;
    return i >= kFirstMean ? kRounding * (1 + std::abs(numbers[i])) : 0;
}

bool read_shape(ShapeNumbers& dst, const std::string& text)
{
    const std::vector<std::string> words = split(text, ' ');
    std::string ignored;
    for (size_t i = 0; i < kNumbers && words.size() == kNumbers; ++i)
        if (!parse_value(dst[i], words[i], Range { -1e300, 1e300 }, ignored))
            return false;
    return words.size() == kNumbers;
}

} // namespace

std::string mesh_shape(const Mesh& mesh)
{
    if (mesh.instances || mesh.strands || mesh.triangles.empty())
        return "";
    const V3d origin = mesh.positions[mesh.triangles[0][0]]; // far from that of the file, digits would be lost
    std::vector<ShapeSums> blocks(block_count(mesh.triangles.size()));
    parallel_blocks(mesh.triangles.size(),
                    [&](size_t begin, size_t end, size_t block) { blocks[block] = sums_of(mesh, origin, begin, end); });
    ShapeSums all, mean;
    for (const ShapeSums& block : blocks)
        all.add(block);
    if (!(all.area > 0))
        return "";
    mean.add(all, 1 / all.area);
    const V3d c = mean.p, centre = origin + c, spread = mean.pp - c * c;
    const double radius = std::sqrt(std::max(0.0, spread.x + spread.y + spread.z));
    if (!(radius > 0) || !std::isfinite(radius))
        return "";
    const V3d xx = spread / (radius * radius), ux = (mean.up - mean.uv.x * c) / radius,
              vx = (mean.vp - mean.uv.y * c) / radius, n = mean.n;
    const ShapeNumbers numbers { double(mesh.triangles.size()),
                                 radius,
                                 centre.x,
                                 centre.y,
                                 centre.z,
                                 all.area / (radius * radius),
                                 xx.x,
                                 xx.y,
                                 xx.z,
                                 mean.uv.x,
                                 mean.uv.y,
                                 ux.x,
                                 ux.y,
                                 ux.z,
                                 vx.x,
                                 vx.y,
                                 vx.z,
                                 n.x,
                                 n.y,
                                 n.z,
                                 (mean.np - n.dot(c)) / radius,
                                 mean.nf };
    std::string text;
    for (const double number : numbers)
        text += (text.empty() ? "" : " ") + format("{:.9g}", number);
    return text;
}

bool same_shape(const std::string& a, const std::string& b)
{
    ShapeNumbers left, right;
    if (!read_shape(left, a) || !read_shape(right, b))
        return false;
    for (size_t i = 0; i < kNumbers; ++i)
        if (!(std::abs(left[i] - right[i]) <= std::max(tolerance(left, i), tolerance(right, i))))
            return false;
    return true;
}

} // namespace vmlight
