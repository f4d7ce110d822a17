// SPDX-License-Identifier: Apache-2.0
/// Small meshes whose visibility has a closed form.
#pragma once

#include <vmlight/mesh/mesh.h>

#include <array>
#include <cmath>
#include <vector>

namespace vmlight::scenes {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

/// Add a quad a, b, c, d, counter-clockwise seen from outside, with uvs over the rectangle (u0, v0)-(u1, v1), or none.
inline void add_quad(Mesh& mesh, V3d a, V3d b, V3d c, V3d d, V2f uv0 = V2f(NAN), V2f uv1 = V2f(NAN))
{
    const uint32_t first = uint32_t(mesh.positions.size());
    const V3f normal = V3f((b - a).cross(c - a).normalized());
    for (const V3d& p : { a, b, c, d }) {
        mesh.positions.push_back(p);
        mesh.normals.push_back(normal);
    }
    for (const V2f& uv : { uv0, V2f(uv1.x, uv0.y), uv1, V2f(uv0.x, uv1.y) })
        mesh.uvs.push_back(uv);
    mesh.triangles.push_back({ first, first + 1, first + 2 });
    mesh.triangles.push_back({ first, first + 2, first + 3 });
    mesh.triangle_materials.resize(mesh.triangles.size());
}

/// A square of side 2 `half` around `centre` in the plane z = centre.z, facing +z, over the whole texture.
inline Mesh floor_facing_z(double half, V3d centre = V3d(0))
{
    Mesh mesh;
    mesh.name = "floor";
    const double h = half;
    add_quad(mesh, centre + V3d(-h, -h, 0), centre + V3d(h, -h, 0), centre + V3d(h, h, 0), centre + V3d(-h, h, 0),
             V2f(0, 0), V2f(1, 1));
    return mesh;
}

/// An occluder without uvs: one quad.
inline Mesh quad(V3d a, V3d b, V3d c, V3d d)
{
    Mesh mesh;
    mesh.name = "quad";
    add_quad(mesh, a, b, c, d);
    return mesh;
}

/// A disc facing -z (as a fan of `sides` triangles with the disc's area), without uvs.
inline Mesh disc(V3d centre, double radius, int sides = 2000)
{
    Mesh mesh;
    mesh.name = "disc";
    const double step = 2 * M_PI / sides, r = radius * std::sqrt(step / std::sin(step));
    mesh.positions.push_back(centre);
    for (int i = 0; i < sides; ++i)
        mesh.positions.push_back(centre + V3d(r * std::cos(i * step), r * std::sin(i * step), 0));
    mesh.normals.assign(mesh.positions.size(), V3f(0, 0, -1));
    for (int i = 0; i < sides; ++i)
        mesh.triangles.push_back({ 0, uint32_t(1 + (i + 1) % sides), uint32_t(1 + i) });
    mesh.triangle_materials.assign(mesh.triangles.size(), 0);
    return mesh;
}

/// A sphere of `rings` x 2 `rings` quads, each with its own cell of the texture; smooth normals.
inline Mesh sphere(V3d centre, double radius, int rings, bool inward = false)
{
    Mesh mesh;
    mesh.name = "sphere";
    const int columns = 2 * rings;
    for (int j = 0; j <= rings; ++j)
        for (int i = 0; i <= columns; ++i) {
            const double theta = M_PI * j / rings, phi = 2 * M_PI * i / columns;
            const bool pole = j == 0 || j == rings; // exact, so that the two ends of a ring share their bits
            const V3d d(pole ? 0 : std::sin(theta) * std::cos(i % columns * 2 * M_PI / columns),
                        pole ? 0 : std::sin(theta) * std::sin(i % columns * 2 * M_PI / columns), std::cos(theta));
            mesh.positions.push_back(centre + d * radius);
            mesh.normals.push_back(V3f(d) * (inward ? -1.0f : 1.0f));
            mesh.uvs.push_back(V2f(float(phi / (2 * M_PI)), float(1 - theta / M_PI)));
        }
    for (int j = 0; j < rings; ++j)
        for (int i = 0; i < columns; ++i) {
            const uint32_t a = uint32_t(j * (columns + 1) + i), b = a + 1, c = a + uint32_t(columns) + 1, d = c + 1;
            for (std::array<uint32_t, 3> t : { std::array<uint32_t, 3> { a, c, d }, { a, d, b } }) {
                if ((j == 0 && t[1] == d) || (j == rings - 1 && t[1] == c))
                    continue; // no area at the poles
                if (inward)
                    std::swap(t[1], t[2]);
                mesh.triangles.push_back(t);
            }
        }
    mesh.triangle_materials.assign(mesh.triangles.size(), 0);
    return mesh;
}

/// The six walls of a box from `low` to `high`, each over its own cell of a 3 x 2 atlas with a border; facing inwards
/// or outwards.
inline Mesh box(V3d low, V3d high, bool inward, double border = 0.01)
{
    Mesh mesh;
    mesh.name = "box";
    const V3d& l = low;
    const V3d& h = high;
    const V3d p[8] = { { l.x, l.y, l.z }, { h.x, l.y, l.z }, { h.x, h.y, l.z }, { l.x, h.y, l.z },
                       { l.x, l.y, h.z }, { h.x, l.y, h.z }, { h.x, h.y, h.z }, { l.x, h.y, h.z } };
    const int sides[6][4]
        = { { 0, 3, 2, 1 }, { 4, 5, 6, 7 }, { 0, 1, 5, 4 }, { 2, 3, 7, 6 }, { 1, 2, 6, 5 }, { 3, 0, 4, 7 } };
    for (int s = 0; s < 6; ++s) {
        const int* q = sides[s];
        const V2f uv0(float((s % 3 + border) / 3), float((s / 3 + border) / 2));
        const V2f uv1(float((s % 3 + 1 - border) / 3), float((s / 3 + 1 - border) / 2));
        if (inward)
            add_quad(mesh, p[q[3]], p[q[2]], p[q[1]], p[q[0]], uv0, uv1);
        else
            add_quad(mesh, p[q[0]], p[q[1]], p[q[2]], p[q[3]], uv0, uv1);
    }
    return mesh;
}

/// A rectangle from `corner` along two sides, without uvs.
inline Mesh rectangle(V3d corner, V3d side1, V3d side2)
{
    return quad(corner, corner + side1, corner + side1 + side2, corner + side2);
}

/// The wall of a round pit around the z axis, from z = 0 to `height`, without uvs; the prism's cross section has the
/// circle's area.
inline Mesh tube(double radius, double height, int sides = 1000)
{
    Mesh mesh;
    mesh.name = "tube";
    const double step = 2 * M_PI / sides, r = radius * std::sqrt(step / std::sin(step));
    const auto point = [&](int i, double z) { return V3d(r * std::cos(i * step), r * std::sin(i * step), z); };
    for (int i = 0; i < sides; ++i)
        add_quad(mesh, point(i + 1, 0), point(i, 0), point(i, height), point(i + 1, height));
    return mesh;
}

/// An icosahedron, its faces cut in four `cuts` times and pushed out to the unit sphere, with the sphere's normals and
/// each triangle over its own cell of the texture: 20, 80, 320, ... triangles.
inline Mesh icosphere(int cuts)
{
    const double g = (1 + std::sqrt(5.0)) / 2;
    const std::vector<V3d> ico {
        { -1, g, 0 },  { 1, g, 0 },  { -1, -g, 0 }, { 1, -g, 0 }, { 0, -1, g },  { 0, 1, g },
        { 0, -1, -g }, { 0, 1, -g }, { g, 0, -1 },  { g, 0, 1 },  { -g, 0, -1 }, { -g, 0, 1 }
    };
    const int faces[20][3]
        = { { 0, 11, 5 },  { 0, 5, 1 },  { 0, 1, 7 },  { 0, 7, 10 }, { 0, 10, 11 }, { 1, 5, 9 }, { 5, 11, 4 },
            { 11, 10, 2 }, { 10, 7, 6 }, { 7, 1, 8 },  { 3, 9, 4 },  { 3, 4, 2 },   { 3, 2, 6 }, { 3, 6, 8 },
            { 3, 8, 9 },   { 4, 9, 5 },  { 2, 4, 11 }, { 6, 2, 10 }, { 8, 6, 7 },   { 9, 8, 1 } };
    std::vector<std::array<V3d, 3>> triangles;
    for (const auto& f : faces)
        triangles.push_back({ ico[f[0]].normalized(), ico[f[1]].normalized(), ico[f[2]].normalized() });
    for (int cut = 0; cut < cuts; ++cut) {
        std::vector<std::array<V3d, 3>> finer;
        for (const auto& [a, b, c] : triangles) {
            const V3d ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
            finer.insert(finer.end(), { { a, ab, ca }, { ab, b, bc }, { ca, bc, c }, { ab, bc, ca } });
        }
        triangles.swap(finer);
    }
    Mesh mesh;
    mesh.name = "icosphere";
    const int across = int(std::ceil(std::sqrt(double(triangles.size()))));
    for (size_t t = 0; t < triangles.size(); ++t) {
        const double u = double(int(t) % across), v = double(int(t) / across), lo = 0.02, hi = 0.98;
        const V2f uvs[3] = { V2f(float((u + lo) / across), float((v + lo) / across)),
                             V2f(float((u + hi) / across), float((v + lo) / across)),
                             V2f(float((u + lo) / across), float((v + hi) / across)) };
        for (int k = 0; k < 3; ++k) {
            mesh.positions.push_back(triangles[t][k]);
            mesh.normals.push_back(V3f(triangles[t][k]));
            mesh.uvs.push_back(uvs[k]);
        }
        const uint32_t first = uint32_t(3 * t);
        mesh.triangles.push_back({ first, first + 1, first + 2 });
        mesh.triangle_materials.push_back(0);
    }
    return mesh;
}

/// A wall without uvs, without end but for its foot on z = 0, which hides half of what a floor at x < 1 sees.
inline const Mesh& wall_at_x1()
{
    static const Mesh wall = rectangle(V3d(1, -1e5, 0), V3d(0, 2e5, 0), V3d(0, 0, 1e5));
    return wall;
}

/// Turn every triangle over; normals stay.
inline Mesh rewound(Mesh mesh)
{
    for (auto& triangle : mesh.triangles)
        std::swap(triangle[1], triangle[2]);
    return mesh;
}

/// Scale, then move.
inline Mesh placed(Mesh mesh, double scale, V3d offset = V3d(0))
{
    for (V3d& p : mesh.positions)
        p = p * scale + offset;
    return mesh;
}

inline void append(Mesh& mesh, const Mesh& other)
{
    const uint32_t first = uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    mesh.uvs.insert(mesh.uvs.end(), other.uvs.begin(), other.uvs.end());
    for (const auto& t : other.triangles)
        mesh.triangles.push_back({ t[0] + first, t[1] + first, t[2] + first });
    for (const uint32_t material : other.triangle_materials)
        mesh.triangle_materials.push_back(material);
}

} // namespace vmlight::scenes
