// SPDX-License-Identifier: Apache-2.0
// Any bytes as what the mesh importer might hand over: refused in one line, or baked to a map that the contract allows,
// the same one on two threads. The importer itself is not ours; bytes that
// begin with "ply" or "obj" are files, looked at as before they are given to it.
//   mesh_fuzz -max_total_time=60 NEW_CORPUS tests/fuzz/mesh_corpus
#include "law.h"
#include "scene_of_bytes.h"

#include <vmlight/mesh/import/mesh_of_scene.h>
#include <vmlight/mesh/import/ply.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <unistd.h>

using namespace vmlight;
using namespace vmlight::fuzz;
using OIIO::Strutil::fmt::format;

namespace {

std::string said(const Imath::V3d& v)
{
    return format("({}, {}, {})", v.x, v.y, v.z);
}

// Vertices that no float holds.
ExactPositions exact_of(const aiScene& scene)
{
    ExactPositions exact;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        exact.emplace_back();
        for (unsigned i = 0; i < scene.mMeshes[m]->mNumVertices; ++i) {
            const aiVector3D& v = scene.mMeshes[m]->mVertices[i];
            exact.back().emplace_back(1e9 + double(v.x), 1e-300 * double(v.y), 1e250 * double(v.z));
        }
    }
    return exact;
}

bool read_scene(Mesh& mesh, Bytes& bytes)
{
    MeshParams params;
    params.normals = bytes.choice(std::array<const char*, 3> { "file", "smooth", "flat" });
    params.crease_angle = double(bytes.below(181));
    params.uv_set = int(bytes.below(3));
    params.up = bytes.choice(std::array<const char*, 3> { "file", "y", "z" });
    mesh.name = "fuzz";
    const bool has_exact = bytes.flag();
    const std::unique_ptr<aiScene> scene = scene_of(bytes);
    std::string error;
    if (!mesh_of_scene(mesh, *scene, has_exact ? exact_of(*scene) : ExactPositions(), params, error)) {
        require_reason(error);
        return false;
    }
    require(error.empty() && !mesh.triangles.empty() && mesh.normals.size() == mesh.positions.size()
                && mesh.materials.size() == mesh.triangles.size()
                && (mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size()),
            "a mesh is whole", error);
    for (const auto& triangle : mesh.triangles)
        for (uint32_t vertex : triangle)
            require(vertex < mesh.positions.size(), "a corner is a vertex", std::to_string(vertex));
    for (const Imath::V3d& p : mesh.positions)
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "positions are finite", said(p));
    for (const Imath::V3f& n : mesh.normals)
        require(n == Imath::V3f(0) || std::abs(n.length() - 1) < 1e-5, "normals are of unit length", said(n));
    return true;
}

VismapParams params_of(Bytes& bytes)
{
    VismapParams params;
    params.resolution = { int(1 + bytes.below(8)), int(1 + bytes.below(8)) };
    const bool elsewhere = bytes.flag();
    params.udim = kFirstUdim + int(bytes.below(99)) * elsewhere;
    params.samples = int(1 + bytes.below(16));
    params.sampler = bytes.choice(std::array<const char*, 3> { "fibonacci", "sobol", "halton" });
    params.measure = bytes.choice(std::array<const char*, 4> { "cosine", "cosine", "cosine", "uniform" });
    params.basis = bytes.choice(std::array<const char*, 4> { "vector", "sh", "mask", "cells" });
    params.order = int(1 + bytes.below(12));
    params.seed = bytes.byte();
    params.margin = int(bytes.below(10)) - 1;
    params.max_distance = bytes.number();
    params.target_error = bytes.flag() ? 0.1 : 0;
    params.channels = { "normal", "coverage" };
    if (bytes.flag())
        params.channels.push_back("error");
    return params;
}

void require_contract(const OIIO::ImageBuf& map, const VismapParams& params)
{
    const int normal = map.spec().channelindex("normal.x"), coverage = map.spec().channelindex("coverage");
    for (OIIO::ImageBuf::ConstIterator<float> texel(map); !texel.done(); ++texel) {
        const float visibility = texel[0], covered = texel[coverage];
        const Imath::V3d direction(texel[1], texel[2], texel[3]);
        require(visibility >= 0 && visibility <= 1, "V is in [0, 1]", format("{}", visibility));
        require(direction.length() <= visibility * (1 + 1e-6), "|B| is at most V",
                format("{} of {}", said(direction), visibility));
        require(covered == 0 || covered == 1, "coverage is 0 or 1", format("{}", covered));
        const Imath::V3d n(texel[normal], texel[normal + 1], texel[normal + 2]);
        require(covered == 0 || std::abs(n.length() - 1) < 1e-5, "a covered texel has a normal", said(n));
    }
    require(map.spec().width == params.size().width && map.spec().height == params.size().height,
            "a map has the size that was asked for", format("{}x{}", map.spec().width, map.spec().height));
}

void try_scene(Bytes& bytes)
{
    std::vector<Mesh> meshes(1);
    const VismapParams params = params_of(bytes);
    const bool has_occluder = bytes.flag();
    if (!read_scene(meshes[0], bytes))
        return;
    std::vector<Mesh> occluders(has_occluder ? 1 : 0);
    if (has_occluder && !read_scene(occluders[0], bytes))
        return;
    OIIO::ImageBuf map, again;
    VismapReport report;
    const bool made = make_vismap(map, meshes[0], occluders, params, &report, 1);
    require_made(made, map);
    if (!made)
        return;
    require_contract(map, params);
    require(std::isfinite(report.error), "an error is finite", format("{}", report.error));
    require(make_vismap(again, meshes[0], occluders, params, nullptr, 2), "what is made is made again",
            again.geterror());
    require(pixels_of(again) == pixels_of(map), "two threads bake what one does", "");
}

void require_file(const MeshFile& file)
{
    if (!file.fault.empty())
        require_reason(file.fault);
    for (const Imath::V3d& p : file.positions)
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "positions are finite", said(p));
}

void try_obj(const std::string& text)
{
    const std::string path = format("/tmp/mesh_fuzz.{}.obj", ::getpid());
    require(OIIO::Filesystem::write_text_file(path, text), "a file can be written", path);
    require_file(inspect_mesh_file(path));
    OIIO::Filesystem::remove(path);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    Bytes bytes(data, size);
    const std::string start = std::string(data, data + std::min<size_t>(size, 3));
    if (start == "ply")
        require_file(inspect_ply(bytes.rest()));
    else if (start == "obj")
        try_obj(bytes.rest().substr(3));
    else
        try_scene(bytes);
    return 0;
}
