// SPDX-License-Identifier: Apache-2.0
/// Scenes drawn at random, small enough that hundreds are baked in a moment.
#pragma once

#include "drawn_surface.h"
#include "scenes.h"

#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imagebuf.h>

#include <random>
#include <string>
#include <vector>

namespace vmlight {

/// What a seed draws. Parts can be taken away, to find what of a failing scene it takes to fail.
struct DrawnScene
{
    Mesh mesh;
    std::vector<Mesh> occluders;
    OIIO::ImageBuf normal_map; ///< not initialized: none
    NormalMapParams normal_map_params;
    VismapParams params;

    explicit DrawnScene(uint32_t seed)
    {
        using namespace scenes;
        std::mt19937 random(seed);
        const auto number
            = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
        const auto one_of = [&](int count) { return std::uniform_int_distribution<int>(0, count - 1)(random); };
        // Braces: draws in one order whatever the compiler.
        const auto place = [&](double far) { return V3d { number(-far, far), number(-far, far), number(-far, far) }; };
        const auto shape = [&](bool baked) {
            double height;
            int rows;
            switch (one_of(baked ? 5 : 6)) {
            case 0:
                return icosphere(one_of(3));
            case 1:
                return box(V3d(-1, -0.5, -0.7), V3d(1, 0.5, 0.7), one_of(4) == 0);
            case 2:
                return floor_facing_z(1);
            case 3:
                height = number(-0.3, 0.3);
                return bumpy(height, 3 + one_of(4));
            case 4:
                rows = 4 + one_of(4);
                return sphere(V3d(0), 1, rows, one_of(4) == 0);
            default:
                return quad(V3d(-1, 0, -1), V3d(-1, 0, 1), V3d(1, 0, 1), V3d(1, 0, -1));
            }
        };
        const double scale = std::pow(10.0, number(-3, 3));
        const V3d offset = one_of(3) ? V3d(0) : place(50) * scale;
        const V3d axis = place(1).normalized();
        const double angle = one_of(3) ? 0 : number(0, 6);
        const auto set = [&](Mesh mesh, double size, V3d at) {
            for (size_t i = 0; i < mesh.positions.size(); ++i) {
                mesh.positions[i] = turn(mesh.positions[i], axis, angle) * size + at;
                mesh.normals[i] = V3f(turn(V3d(mesh.normals[i]), axis, angle));
            }
            return mesh;
        };
        mesh = set(shape(true), scale, offset);
        for (int left = one_of(4); left > 0; --left) {
            const double size = scale * std::pow(10.0, number(-1, 0.5));
            // Some touch the mesh or lie in its planes.
            const V3d at = offset + (one_of(3) ? place(3) * scale : one_of(2) ? V3d(0) : V3d(0, -2 * scale, 0));
            occluders.push_back(set(shape(false), size, at));
            occluders.back().name = "occluder " + std::to_string(left);
        }
        params.resolution = { 6 + one_of(12), 6 + one_of(12) };
        params.samples = 1 + one_of(40);
        params.seed = one_of(1000);
        params.sampler = one_of(2) ? "fibonacci" : "sobol";
        params.measure = one_of(5) ? "cosine" : "uniform";
        params.margin = one_of(3);
        if (params.measure == "cosine")
            params.basis = one_of(3) ? "vector" : one_of(2) ? "sh" : one_of(2) ? "mask" : "cells";
        if (one_of(4) == 0 && params.samples > 1)
            params.channels = { "normal", "error" };
        if (one_of(3) == 0)
            params.max_distance = scale * std::pow(10.0, number(-1, 1));
        params.ground = one_of(3) == 0;
        if (params.ground && one_of(2))
            params.ground_height = offset.y + scale * number(-3, 1);
        // What is drawn last leaves the rest of a seed as it is: further effects go here.
        for (Mesh* one : all_meshes())
            if (one_of(4) == 0)
                drawn_surface::cut_out(*one, random);
        if (one_of(3) == 0)
            normal_map = drawn_surface::normal_map(normal_map_params, random);
        params.reconstruct = one_of(2) ? "auto" : "off";
    }

    std::vector<Mesh*> all_meshes()
    {
        std::vector<Mesh*> all { &mesh };
        for (Mesh& occluder : occluders)
            all.push_back(&occluder);
        return all;
    }

private:
    static Imath::V3d turn(const Imath::V3d& p, const Imath::V3d& axis, double angle)
    {
        return p * std::cos(angle) + axis.cross(p) * std::sin(angle) + axis * (axis.dot(p) * (1 - std::cos(angle)));
    }

    // A square of `n` x `n` flat quads with a hill or a hollow in the middle of its edge rows.
    static Mesh bumpy(double height, int n)
    {
        Mesh mesh;
        mesh.name = "bumpy";
        const auto at = [&](int i, int k) {
            const double x = 2.0 * i / n - 1, y = 2.0 * k / n - 1;
            return Imath::V3d(x, y, i > 0 && i < n && k > 0 && k < n && i > n / 2 ? height : 0);
        };
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < n; ++k)
                scenes::add_quad(mesh, at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1),
                                 Imath::V2f(float(i) / float(n), float(k) / float(n)),
                                 Imath::V2f(float(i + 1) / float(n), float(k + 1) / float(n)));
        return mesh;
    }
};

} // namespace vmlight
