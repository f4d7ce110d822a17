// SPDX-License-Identifier: Apache-2.0
// Any bytes as what assimp might import: refused in one line, or baked to a map that the contract allows, the same on
// one thread and on two. Assimp itself is not fuzzed, but for its cutting of polygons; bytes that begin with "ply",
// "obj" or "mtl" are files that are read without it.
//   mesh_fuzz -max_total_time=60 NEW_CORPUS tests/fuzz/mesh_corpus
#include "imported_of_bytes.h"
#include "law.h"
#include "mesh_law.h"

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/assimp_importer.h>
#include <vmlight/mesh/import/mtl.h>
#include <vmlight/mesh/import/obj.h>
#include <vmlight/mesh/import/ply.h>
#include <vmlight/vismap/vismap.h>

using namespace vmlight;
using namespace vmlight::fuzz;

namespace {

bool read_imported(Mesh& mesh, Bytes& bytes)
{
    MeshParams params;
    params.normals = bytes.choice(std::array<const char*, 3> { "file", "smooth", "flat" });
    params.crease_angle = double(bytes.below(181));
    params.uv_set = int(bytes.below(3));
    params.up = bytes.choice(std::array<const char*, 3> { "file", "y", "z" });
    mesh.name = "fuzz";
    bytes.flag(); // chose doubles once; the corpus has it
    const std::unique_ptr<aiScene> imported = imported_of(bytes);
    MeshBuilder builder(mesh, params);
    append_imported(builder, *imported, "");
    std::string error;
    if (!builder.finish(error)) {
        require_reason(error);
        return false;
    }
    require(error.empty(), "what is read has no error", error);
    require_whole(mesh);
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

void try_bake(Bytes& bytes)
{
    std::vector<Mesh> meshes(1);
    const VismapParams params = params_of(bytes);
    const bool has_occluder = bytes.flag();
    if (!read_imported(meshes[0], bytes))
        return;
    std::vector<Mesh> occluders(has_occluder ? 1 : 0);
    if (has_occluder && !read_imported(occluders[0], bytes))
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

// A mesh of what `append` reads of a file, refused with a reason or whole.
template <class Append> void try_read(const Append& append)
{
    Mesh mesh;
    const MeshParams params;
    MeshBuilder builder(mesh, params);
    std::string error;
    if (!append(builder, error) || !builder.finish(error)) {
        require_reason(error);
        return;
    }
    require_whole(mesh);
    for (const uint32_t material : mesh.triangle_materials)
        require(material < mesh.materials.size(), "a triangle's material is there", std::to_string(material));
    for (const std::string& warning : mesh.warnings)
        require_reason(warning);
}

void try_ply(const std::string& bytes)
{
    try_read([&](MeshBuilder& builder, std::string& error) {
        ply::File file;
        return ply::parse(file, bytes, error) && append_ply(builder, file, "none", error);
    });
}

void try_obj(const std::string& text)
{
    try_read([&](MeshBuilder& builder, std::string& error) {
        obj::File file;
        return obj::parse(file, text, error) && append_obj(builder, file, {}, error);
    });
}

void try_mtl(const std::string& text)
{
    std::vector<Material> materials;
    add_mtl_materials(materials, text, "none");
    for (const Material& material : materials)
        require(!material.name.empty() && material.base_color.a >= 0 && material.base_color.a <= 1,
                "a material has a name, and an opacity", material.name);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    Bytes bytes(data, size);
    const std::string start = std::string(data, data + std::min<size_t>(size, 3));
    if (start == "ply")
        try_ply(bytes.rest());
    else if (start == "obj")
        try_obj(bytes.rest().substr(3));
    else if (start == "mtl")
        try_mtl(bytes.rest().substr(3));
    else
        try_bake(bytes);
    return 0;
}
