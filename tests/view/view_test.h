// SPDX-License-Identifier: Apache-2.0
/// What the tests of vmview share: an OpenGL context for each test, and lit things.
#pragma once

#include "vmview/gl/fault.h"
#include "vmview/gl/headless.h"
#include "vmview/gl/objects.h"

#include <vmlight/cfem/stack.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imagebuf.h>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight::view {

/// A test that draws. Skipped where EGL gives no context; fails if OpenGL finds a wrong call.
class DrawingTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        std::string error;
        m_context = HeadlessContext::open(error);
        if (!m_context)
            GTEST_SKIP() << error;
        m_vertices = make_vertex_array();
        glBindVertexArray(m_vertices.get());
    }
    void TearDown() override
    {
        if (!m_context)
            return;
        EXPECT_EQ(gl_fault(), "");
        m_vertices = VertexArray();
        m_context.reset();
    }

private:
    std::unique_ptr<HeadlessContext> m_context;
    VertexArray m_vertices;
};

inline std::string data_path(const std::string& name)
{
    return std::string(VMLIGHT_TEST_DATA) + "/" + name;
}

inline Mesh data_mesh(const std::string& name)
{
    Mesh mesh;
    std::string error;
    EXPECT_TRUE(read_mesh(mesh, data_path(name), {}, error)) << error;
    return mesh;
}

/// A square in the plane z = 0 that faces +z, of `size` by `size` around the origin, with the whole texture on it.
inline Mesh square(double size = 1)
{
    Mesh mesh;
    for (int i = 0; i < 4; ++i) {
        const float s = float(i % 2), t = float(i / 2);
        mesh.positions.emplace_back(size * (s - 0.5), size * (t - 0.5), 0);
        mesh.normals.emplace_back(0, 0, 1);
        mesh.uvs.emplace_back(s, t);
    }
    mesh.triangles = { { 0, 1, 3 }, { 0, 3, 2 } };
    return mesh;
}

/// A map of `mesh` for all models that are shaded on the graphics card.
inline OIIO::ImageBuf full_map(const Mesh& mesh, Size size, int samples = 16)
{
    VismapParams params;
    params.resolution = size;
    params.samples = samples;
    params.basis = "sh";
    params.margin = 4;
    params.channels = { "normal", "coverage" };
    OIIO::ImageBuf map;
    EXPECT_TRUE(make_vismap(map, mesh, {}, params)) << map.geterror();
    return map;
}

/// The stack of an environment of tests/data.
inline std::vector<OIIO::ImageBuf> data_light(const std::string& name, Size size = { 128, 64 })
{
    const OIIO::ImageBuf environment(data_path(name));
    CfemParams params;
    params.resolution = size;
    std::vector<OIIO::ImageBuf> stack;
    std::string error;
    EXPECT_TRUE(make_cfem_stack(stack, environment, params, error)) << error;
    return stack;
}

/// The largest difference of two lists of numbers, relative to their mean magnitude.
inline double largest_difference(const std::vector<float>& a, const std::vector<float>& b)
{
    EXPECT_EQ(a.size(), b.size());
    double largest = 0, sum = 0;
    for (size_t i = 0; i < a.size() && i < b.size(); ++i) {
        largest = std::max(largest, std::abs(double(a[i]) - b[i]));
        sum += std::abs(double(b[i]));
    }
    return largest / (sum / double(b.size()));
}

} // namespace vmlight::view
