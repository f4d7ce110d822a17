// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/shape.h>

#include <vmlight/base/format.h>
#include <vmlight/base/parallel_blocks.h>
#include <vmlight/base/text.h>
#include <vmlight/base/text_format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace vmlight {
namespace {

using Imath::V2d;
using Imath::V3d;

constexpr double kRounding = 1e-5;
constexpr double kNormalRounding = 1e-4; // some programs write four digits
constexpr double kFarRounding = 1e-6; // of positions, by the distance from the origin

template <size_t count> using Sums = std::array<double, count>;

struct SurfaceCorner
{
    V3d position;
    V2d uv;
    V3d normal, face; // of unit length
};

// The sum over all corners of triangles of what `of` returns, weighted by area.
template <size_t count, class Function> Sums<count> over_surface(const Mesh& mesh, const Function& of)
{
    std::vector<Sums<count>> blocks(block_count(mesh.triangles.size()), Sums<count> {});
    parallel_blocks(mesh.triangles.size(), [&](size_t begin, size_t end, size_t block) {
        for (size_t t = begin; t < end; ++t) {
            const auto& [a, b, c] = mesh.triangles[t];
            const V3d face = (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
            const double twice = face.length();
            if (!(twice > 0))
                continue;
            for (const uint32_t v : { a, b, c }) {
                const V2d uv = has_uv(mesh, v) ? V2d(mesh.uvs[v]) : V2d(0);
                const Sums<count> values
                    = of(SurfaceCorner { mesh.positions[v], uv, V3d(mesh.normals[v]), face / twice });
                for (size_t i = 0; i < count; ++i)
                    blocks[block][i] += twice / 6 * values[i];
            }
        }
    });
    Sums<count> all {};
    for (const Sums<count>& block : blocks)
        for (size_t i = 0; i < count; ++i)
            all[i] += block[i];
    return all;
}

// Of mesh_shape()'s text, in this order.
struct Shape
{
    static constexpr size_t kMeans = 16, kNormalMeans = 5;

    double triangles = 0, radius = 0; // root of the mean square distance from the centre
    V3d centre { 0 };
    double area = 0; // by the square of the radius
    Sums<kMeans> means {}; // see means_of(); the last kNormalMeans have normals in them

    // The numbers, and what two of one mesh may differ by.
    std::vector<std::pair<double, double>> numbers() const
    {
        std::vector<std::pair<double, double>> found { { triangles, 0 }, { radius, kRounding * radius } };
        for (int axis = 0; axis < 3; ++axis)
            found.emplace_back(centre[axis], kRounding * radius + kFarRounding * centre.length());
        found.emplace_back(area, 10 * kRounding * area);
        for (size_t i = 0; i < kMeans; ++i)
            found.emplace_back(means[i],
                               i + kNormalMeans < kMeans ? kRounding * (1 + std::abs(means[i])) : kNormalRounding);
        return found;
    }
};

constexpr size_t kNumbers = 6 + Shape::kMeans;

// `p` is from the centre, by the radius.
Sums<Shape::kMeans> means_of(const V3d& p, const SurfaceCorner& corner)
{
    const V2d& uv = corner.uv;
    const V3d& n = corner.normal;
    return { p.x * p.x,  p.y * p.y,  p.z * p.z,  uv.x, uv.y, uv.x * p.x, uv.x * p.y, uv.x * p.z,
             uv.y * p.x, uv.y * p.y, uv.y * p.z, n.x,  n.y,  n.z,        n.dot(p),   n.dot(corner.face) };
}

bool read_shape(Shape& dst, const std::string& text)
{
    const std::vector<std::string> words = split(text, ' ');
    if (words.size() != kNumbers)
        return false;
    std::array<double, kNumbers> numbers {};
    for (size_t i = 0; i < kNumbers; ++i) {
        char* end = nullptr;
        numbers[i] = number_at(words[i].c_str(), &end);
        if (end == words[i].c_str() || *end || !std::isfinite(numbers[i]))
            return false;
    }
    dst.triangles = numbers[0];
    dst.radius = numbers[1];
    dst.centre = { numbers[2], numbers[3], numbers[4] };
    dst.area = numbers[5];
    std::copy(numbers.begin() + 6, numbers.end(), dst.means.begin());
    return true;
}

} // namespace

std::string mesh_shape(const Mesh& mesh)
{
    if (mesh.instances || mesh.strands)
        return "";
    Shape shape;
    shape.triangles = double(mesh.triangles.size());
    const V3d origin = mesh.triangles.empty() ? V3d(0) : mesh.positions[mesh.triangles[0][0]];
    const auto place = over_surface<5>(mesh, [&](const SurfaceCorner& corner) {
        const V3d p = corner.position - origin;
        return Sums<5> { 1, p.x, p.y, p.z, p.length2() };
    });
    const double area = place[0];
    if (!(area > 0))
        return "";
    const V3d centre = V3d(place[1], place[2], place[3]) / area;
    shape.centre = origin + centre;
    shape.radius = std::sqrt(std::max(0.0, place[4] / area - centre.length2()));
    if (!(shape.radius > 0) || !std::isfinite(shape.radius))
        return "";
    shape.area = area / (shape.radius * shape.radius);
    shape.means = over_surface<Shape::kMeans>(mesh, [&](const SurfaceCorner& corner) {
        return means_of((corner.position - shape.centre) / shape.radius, corner);
    });
    for (double& mean : shape.means)
        mean /= area;
    std::string text;
    for (const auto& [number, tolerance] : shape.numbers())
        text += (text.empty() ? "" : " ") + format("{:.9g}", number);
    return text;
}

bool same_shape(const std::string& a, const std::string& b)
{
    Shape one, other;
    if (!read_shape(one, a) || !read_shape(other, b))
        return false;
    const auto left = one.numbers(), right = other.numbers();
    return std::equal(left.begin(), left.end(), right.begin(), [](const auto& l, const auto& r) {
        return std::abs(l.first - r.first) <= std::max(l.second, r.second);
    });
}

} // namespace vmlight
