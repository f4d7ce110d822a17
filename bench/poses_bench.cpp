// SPDX-License-Identifier: Apache-2.0
/// What it saves to bake the poses of a mesh together, as a Markdown table: a flag that waves beside a house on a lawn;
/// and of MESH, such as tests/data/spot.obj, one that nods, and one that walks.
///
///     poses_bench [MESH [RESOLUTION [SAMPLES [FRAMES [JUDGED [ONLY]]]]]]
///
/// CPU seconds of all threads, which other work on the machine hardly changes, for the scenes and maps of all frames,
/// files left out: each frame whole, and as a sequence at several errors. Rays are of all frames but the first,
/// relative to those of plain bakes. RMS of V against 1024 rays a texel, over JUDGED frames (2). ONLY is one of flag,
/// nodding and walking.
#include <vmlight/base/format.h>
#include <vmlight/math/rotation.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/vismap/pose_sequence.h>

#include <Imath/ImathBox.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <utility>
#include <vector>

using namespace vmlight;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

namespace {

using Pose = std::function<Mesh(double time)>; // from 0 to 1

[[noreturn]] void fail(const std::string& error)
{
    std::fprintf(stderr, "poses_bench: %s\n", error.c_str());
    std::exit(1);
}

// A sheet of n x n quads through point(u, v).
template <class Point> void add_sheet(Mesh& mesh, int n, const Point& point, V2f uv0, V2f uv1)
{
    const auto first = uint32_t(mesh.positions.size());
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const double u = double(i) / n, v = double(j) / n, step = 1e-4;
            const V3d along = point(u + step, v) - point(u - step, v), up = point(u, v + step) - point(u, v - step);
            mesh.positions.push_back(V3d(V3f(point(u, v))));
            mesh.normals.push_back(V3f(along.cross(up).normalized()));
            mesh.uvs.emplace_back(uv0.x + (uv1.x - uv0.x) * float(u), uv0.y + (uv1.y - uv0.y) * float(v));
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const uint32_t a = first + uint32_t(j * (n + 1) + i), c = a + uint32_t(n) + 1;
            mesh.triangles.push_back({ a, a + 1, c + 1 });
            mesh.triangles.push_back({ a, c + 1, c });
        }
}

Mesh flag(double time)
{
    Mesh mesh;
    const auto flat
        = [](V3d corner, V3d along, V3d up) { return [=](double u, double v) { return corner + along * u + up * v; }; };
    add_sheet(mesh, 100, flat(V3d(-8, 0, 8), V3d(16, 0, 0), V3d(0, 0, -16)), V2f(0.01f, 0.01f), V2f(0.7f, 0.7f));
    const V3d corners[5] = { V3d(-4, 0, 2), V3d(0, 0, 2), V3d(0, 0, -2), V3d(-4, 0, -2), V3d(-4, 0, 2) };
    for (int side = 0; side < 4; ++side)
        add_sheet(mesh, 30, flat(corners[side], corners[side + 1] - corners[side], V3d(0, 3, 0)),
                  V2f(0.01f + 0.245f * float(side), 0.72f), V2f(0.24f + 0.245f * float(side), 0.98f));
    const auto cloth = [time](double u, double v) {
        return V3d(3 + 1.5 * u, 3 + v, 0.25 * u * std::sin(2 * M_PI * (1.5 * u - time)));
    };
    add_sheet(mesh, 40, cloth, V2f(0.72f, 0.01f), V2f(0.84f, 0.1f));
    add_sheet(
        mesh, 40, [&](double u, double v) { return cloth(1 - u, v) - V3d(0, 0, 0.01); }, V2f(0.86f, 0.01f),
        V2f(0.98f, 0.1f));
    return mesh;
}

// What is in front nods, as a head does: the front of the spot model.
Mesh nodding(const Mesh& mesh, double time)
{
    V3d low(1e300), high(-1e300);
    for (const V3d& p : mesh.positions)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    Mesh pose = mesh;
    const V3d neck(0, low.y + 0.55 * (high.y - low.y), low.z + 0.35 * (high.z - low.z));
    for (size_t i = 0; i < pose.positions.size(); ++i) {
        const double weight = std::clamp((neck.z - pose.positions[i].z) / (0.1 * (high.z - low.z)), 0.0, 1.0);
        const Rotation turn = rotation_from_angles(12 * weight * std::sin(2 * M_PI * time), 0, 0);
        pose.positions[i] = V3d(V3f(neck + rotate(turn, pose.positions[i] - neck)));
        pose.normals[i] = V3f(rotate(turn, V3d(pose.normals[i])));
    }
    return pose;
}

// Each of four legs swings about its hip while the body goes on and bobs: a beast that faces -z and stands on its feet,
// in the proportions of the spot model.
Mesh walking(const Mesh& mesh, double time)
{
    Imath::Box3d box;
    for (const V3d& p : mesh.positions)
        box.extendBy(p);
    const V3d size = box.size(), step(0, 0.01 * size.y * std::sin(4 * M_PI * time), -0.6 * size.z * time);
    const double hip = box.min.y + 0.28 * size.y, foot = 0.12 * size.y;
    Mesh pose = mesh;
    for (size_t i = 0; i < pose.positions.size(); ++i) {
        V3d& p = pose.positions[i];
        const bool is_left = p.x<0, is_hind = p.z> box.min.z + 0.53 * size.z;
        const double weight = std::clamp((hip - p.y) / foot, 0.0, 1.0);
        const double swing = 18 * std::sin(2 * M_PI * (time + (is_left == is_hind ? 0 : 0.5)));
        const Rotation turn = rotation_from_angles(weight * swing, 0, 0);
        const V3d joint(0, hip, box.min.z + (is_hind ? 0.75 : 0.37) * size.z);
        p = V3d(V3f(joint + rotate(turn, p - joint) + step));
        pose.normals[i] = V3f(rotate(turn, V3d(pose.normals[i])));
    }
    return pose;
}

BakeScenePointer scene_of(Mesh mesh)
{
    const auto scene = std::make_shared<BakeScene>();
    std::string error;
    if (!scene->build(std::make_shared<const Mesh>(std::move(mesh)), {}, 0, error))
        fail(error);
    return scene;
}

double cpu_seconds()
{
    return double(std::clock()) / CLOCKS_PER_SEC;
}

double rms(const OIIO::ImageBuf& a, const OIIO::ImageBuf& b)
{
    double squares = 0, texels = 0;
    OIIO::ImageBuf::ConstIterator<float> other(b);
    for (OIIO::ImageBuf::ConstIterator<float> texel(a); !texel.done(); ++texel, ++other)
        if (texel[a.nchannels() - 1] == 1) {
            squares += std::pow(double(texel[0]) - double(other[0]), 2);
            ++texels;
        }
    return std::sqrt(squares / std::max(1.0, texels));
}

void measure(const char* name, const Pose& pose, const VismapParams& params, int frames, int judged_frames)
{
    std::vector<OIIO::ImageBuf> truth;
    std::vector<int> judged;
    for (int i = 1; i <= judged_frames; ++i)
        judged.push_back(i * frames / (judged_frames + 2));
    for (const int frame : judged) {
        VismapParams exact = params;
        exact.samples = 1024;
        exact.seed = 1;
        if (!make_vismap(truth.emplace_back(), scene_of(pose(double(frame) / frames)), exact, nullptr, 0, {}))
            fail(truth.back().geterror());
    }
    double whole_seconds = 0, whole_rays = 0;
    for (const double error : { -1.0, 0.0, 0.005, 0.01, 0.02 }) {
        PoseSequence sequence(std::max(0.0, error));
        double seconds = 0, first = 0, rays = 0, kept = 0, covered = 0, off = 0, build = 0;
        for (int frame = 0; frame < frames; ++frame) {
            const Mesh mesh = pose(double(frame) / frames);
            const double start = cpu_seconds();
            const BakeScenePointer scene = scene_of(mesh);
            build += cpu_seconds() - start;
            OIIO::ImageBuf map;
            VismapReport report;
            const bool made = error < 0 ? make_vismap(map, scene, params, &report, 0, {})
                                        : sequence.bake(map, { scene, params, 0, {}, 0, nullptr }, "", &report);
            seconds += cpu_seconds() - start;
            if (!made)
                fail(map.geterror());
            first = frame == 0 ? seconds : first;
            rays += frame == 0 ? 0 : double(report.rays);
            kept += error < 0 ? 0 : double(sequence.last().kept);
            covered += frame == 0 ? 0 : double(report.covered);
            for (size_t i = 0; i < judged.size(); ++i)
                if (judged[i] == frame)
                    off += std::pow(rms(map, truth[i]), 2) / double(judged.size());
        }
        if (error < 0) {
            whole_seconds = seconds;
            whole_rays = rays;
        }
        std::printf("| %s | %s | %.1f %% | %.1f %% | %.4f | %.2f | %.2f | %.2f | %.1f |\n", name,
                    error < 0 ? "each whole" : format("{}", error).c_str(), 100 * kept / covered,
                    100 * rays / whole_rays, std::sqrt(off), seconds, first, build, whole_seconds / seconds);
        std::fflush(stdout);
    }
}

} // namespace

int main(int argc, char** argv)
{
    const auto number = [&](int i, int otherwise) { return argc > i ? std::atoi(argv[i]) : otherwise; };
    VismapParams params;
    params.resolution = { number(2, 1024), number(2, 1024) };
    params.samples = number(3, 128);
    params.channels = { "coverage" };
    params.reconstruct = "off";
    const int frames = std::max(2, number(4, 24)), judged = std::max(0, number(5, 2));
    std::printf("| mesh | error | kept | rays | RMS of V | CPU s | of it the first frame | scenes | times as fast "
                "|\n|---|---|---|---|---|---|---|---|---|\n");
    const std::string only = argc > 6 ? argv[6] : "";
    if (only.empty() || only == "flag")
        measure("flag", flag, params, frames, judged);
    if (argc > 1 && argv[1][0]) {
        Mesh mesh;
        std::string error;
        if (!read_mesh(mesh, argv[1], {}, error))
            fail(error);
        for (const auto& [name, pose] : { std::pair("nodding", nodding), { "walking", walking } })
            if (only.empty() || only == name)
                measure(
                    name, [&mesh, move = pose](double time) { return move(mesh, time); }, params, frames, judged);
    }
}
