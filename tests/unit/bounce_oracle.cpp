// SPDX-License-Identifier: Apache-2.0
#include "bounce_oracle.h"

#include <cmath>

namespace vmlight::oracle {
namespace {

// To where a ray meets a triangle; infinite if it does not.
double length_to(const std::array<V3d, 3>& triangle, const V3d& origin, const V3d& direction)
{
    constexpr double kNone = std::numeric_limits<double>::infinity();
    const auto& [a, b, c] = triangle;
    const V3d side1 = b - a, side2 = c - a, p = direction.cross(side2);
    const double scale = side1.dot(p);
    if (scale == 0)
        return kNone;
    const V3d s = (origin - a) / scale, q = s.cross(side1);
    const double u = s.dot(p), v = direction.dot(q), t = side2.dot(q);
    return u >= 0 && v >= 0 && u + v <= 1 && t > 1e-9 ? t : kNone;
}

} // namespace

bool Bounce::is_open(const V3d& origin, const V3d& direction) const
{
    for (const auto& triangle : m_triangles)
        if (length_to(triangle, origin, direction) < m_reach)
            return false;
    return true;
}

Met Bounce::nearest(const V3d& origin, const V3d& direction) const
{
    Met met;
    for (size_t i = 0; i < m_triangles.size(); ++i) {
        const double t = length_to(m_triangles[i], origin, direction);
        if (t < met.distance && t < m_reach) {
            met.distance = t;
            met.triangle = i;
            met.normal = (m_triangles[i][1] - m_triangles[i][0]).cross(m_triangles[i][2] - m_triangles[i][0]);
        }
    }
    met.normal.normalize();
    met.normal *= met.normal.dot(direction) > 0 ? -1 : 1;
    return met;
}

double Bounce::direct(const V3d& at, const V3d& normal, int n)
{
    double sum = 0;
    for (int i = 0; i < n * n; ++i) {
        const V3d way = direction(normal, i % n, i / n, n);
        sum += is_open(at, way) ? m_sky(way) : 0;
    }
    return sum / (n * n);
}

double Bounce::bounced(const V3d& at, const V3d& normal, int n, int inner)
{
    double sum = 0;
    for (int i = 0; i < n * n; ++i) {
        const V3d way = direction(normal, i % n, i / n, n);
        const Met met = nearest(at, way);
        if (met.distance < m_reach)
            sum += m_albedo(met.triangle) * direct(at + way * met.distance, met.normal, inner);
    }
    return sum / (n * n);
}

std::pair<double, double> Bounce::light_of_mapped(const V3d& at, const V3d& surface, const V3d& normal, double own,
                                                  int n, int inner)
{
    double sky = 0, bounced = 0, itself = 0;
    for (int i = 0; i < n * n; ++i) {
        const V3d way = direction(normal, i % n, i / n, n);
        const Met met = way.dot(surface) > 0 ? nearest(at, way) : Met();
        if (!(way.dot(surface) > 0))
            ++itself;
        else if (met.distance < m_reach)
            bounced += m_albedo(met.triangle) * direct(at + way * met.distance, met.normal, inner);
        else
            sky += m_sky(way);
    }
    return { sky / (n * n), (bounced + itself * own * sky / (n * n)) / (n * n) };
}

double Bounce::random()
{
    m_state = m_state * 6364136223846793005u + 1442695040888963407u;
    return double(m_state >> 11) * 0x1p-53;
}

V3d Bounce::direction(const V3d& normal, int column, int row, int n)
{
    const double radius = std::sqrt((row + random()) / n), angle = 2 * M_PI * (column + random()) / n;
    const V3d side = normal.cross(std::abs(normal.x) < 0.5 ? V3d(1, 0, 0) : V3d(0, 1, 0)).normalized();
    return side * (radius * std::cos(angle)) + normal.cross(side) * (radius * std::sin(angle))
        + normal * std::sqrt(1 - radius * radius);
}

std::vector<Place> places(const Mesh& mesh, int width, int height)
{
    std::vector<Place> places(size_t(width) * size_t(height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const auto& [a, b, c] : mesh.triangles) {
                const auto at = [](const V2f& uv) { return Imath::V2d(uv); };
                const Imath::V2d p((x + 0.5) / width, 1 - (y + 0.5) / height), s = at(mesh.uvs[b]) - at(mesh.uvs[a]),
                                                                               t = at(mesh.uvs[c]) - at(mesh.uvs[a]),
                                                                               d = p - at(mesh.uvs[a]);
                const double area = s.cross(t), u = d.cross(t) / area, v = s.cross(d) / area;
                if (!(u >= 0 && v >= 0 && u + v <= 1))
                    continue;
                const V3d &first = mesh.positions[a], side1 = mesh.positions[b] - first,
                          side2 = mesh.positions[c] - first;
                places[size_t(y) * size_t(width) + size_t(x)]
                    = { first + side1 * u + side2 * v, side1.cross(side2).normalized(), true };
                break;
            }
    return places;
}

} // namespace vmlight::oracle
