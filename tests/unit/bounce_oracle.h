// SPDX-License-Identifier: Apache-2.0
/// Bounced light by brute force: in double, triangle by triangle, with nothing of the library but its meshes.
#pragma once

#include "scenes.h"

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace vmlight::oracle {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

struct Met
{
    double distance = std::numeric_limits<double>::infinity();
    size_t triangle = 0;
    V3d normal { 0 }; ///< on the side of the ray
};

/// A scene that has the same albedo on both sides of everything.
class Bounce
{
public:
    /// @param sky      light by direction, of unit length
    /// @param albedo   of a triangle; triangles are counted through all meshes
    Bounce(const std::vector<Mesh>& meshes, std::function<double(const V3d&)> sky,
           std::function<double(size_t triangle)> albedo, double reach = std::numeric_limits<double>::infinity())
        : m_sky(std::move(sky))
        , m_albedo(std::move(albedo))
        , m_reach(reach)
    {
        for (const Mesh& mesh : meshes)
            for (const auto& [a, b, c] : mesh.triangles)
                m_triangles.push_back({ mesh.positions[a], mesh.positions[b], mesh.positions[c] });
    }

    Met nearest(const V3d& origin, const V3d& direction) const;
    bool is_open(const V3d& origin, const V3d& direction) const;

    /// The light of the sky at a point, over pi: the mean over n x n directions, stratified.
    double direct(const V3d& at, const V3d& normal, int n);

    /// What one bounce adds, over pi.
    double bounced(const V3d& at, const V3d& normal, int n, int inner);

    /// What the sky and one bounce give where a normal map makes `normal` of `surface`: what it turns into the surface
    /// meets that, whose albedo is `own`.
    std::pair<double, double> light_of_mapped(const V3d& at, const V3d& surface, const V3d& normal, double own, int n,
                                              int inner);

private:
    double random();
    V3d direction(const V3d& normal, int column, int row, int n);

    std::vector<std::array<V3d, 3>> m_triangles;
    std::function<double(const V3d&)> m_sky;
    std::function<double(size_t)> m_albedo;
    double m_reach;
    uint64_t m_state = 1;
};

/// Where texels are: the centre of each that a triangle of the mesh covers, by the first that does.
struct Place
{
    V3d position, normal;
    bool exists = false;
};
std::vector<Place> places(const Mesh& mesh, int width, int height);

} // namespace vmlight::oracle
