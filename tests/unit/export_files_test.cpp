// SPDX-License-Identifier: Apache-2.0
// What vmexport's files hold, decoded as docs/export.md says.
#include "exported_image.h"
#include "scenes.h"
#include "stack_maps.h"

#include <vmlight/cfem/radiance.h>
#include <vmlight/export/lightmap_encoding.h>
#include <vmlight/export/lit_gltf.h>
#include <vmlight/export/pack.h>
#include <vmlight/export/sh_textures.h>
#include <vmlight/export/target.h>
#include <vmlight/image/color.h>
#include <vmlight/math/latlong.h>
#include <vmlight/mesh/tinygltf.h>
#include <vmlight/vismap/vismap.h>

#include <gmock/gmock.h>

#include <set>

using namespace vmlight;
using namespace scene;
using testing::HasSubstr;
using testing::Not;

TEST(ExportFiles, EachTargetIsOneEntryWithANameOfItsOwn)
{
    std::set<std::string> names;
    for (const ExportTarget& target : export_targets()) {
        EXPECT_TRUE(names.insert(target.name).second) << target.name;
        EXPECT_EQ(find_export_target(target.name), &target);
        EXPECT_LT(target.occlusion.channel, target.occlusion.channels);
    }
    EXPECT_EQ(find_export_target("crayon"), nullptr);
    // As the pages in docs/export.md say.
    for (const char* up : { "godot", "unity", "filament", "three", "gltf" })
        EXPECT_TRUE(find_export_target(up)->green_is_up) << up;
    for (const char* down : { "unreal", "substance" })
        EXPECT_FALSE(find_export_target(down)->green_is_up) << down;
    EXPECT_EQ(find_export_target("unity")->occlusion.channel, 1);
    EXPECT_EQ(find_export_target("godot")->bent_normal, BentNormalSlot::Tangent);
}

TEST(ExportFiles, PngSaysNothingOfColour)
{
    std::string png, error;
    ASSERT_TRUE(encode_png(png, image_of(4, { 0.5f, 0.25f, 1, 0 }), TextureDepth::Sixteen, error)) << error;
    for (const char* chunk : { "gAMA", "sRGB", "iCCP", "cICP", "cHRM", "tIME" })
        EXPECT_EQ(png.find(chunk), std::string::npos) << chunk;
    const ImageBuf read = exported_image(png, "a.png");
    EXPECT_NEAR(read.getchannel(0, 0, 0, 0), 0.5f, 1e-5f); // not multiplied by alpha
}

TEST(ExportFiles, PackingReplacesOneChannelAndKeepsTheOthers)
{
    const ImageBuf occlusion = image_of(1, { 0.25f, 0.75f });
    const OcclusionLayout &red = find_export_target("gltf")->occlusion, &mask = find_export_target("unity")->occlusion;
    ImageBuf packed, base = image_of(3, { 1, 0.5f, 0.125f, 1, 0.25f, 0.5f });
    std::string error;
    ASSERT_TRUE(pack_occlusion(packed, occlusion, red, &base, error)) << error;
    EXPECT_EQ(packed.getchannel(0, 0, 0, 0), 0.25f);
    EXPECT_EQ(packed.getchannel(0, 0, 0, 1), 0.5f);
    EXPECT_EQ(packed.getchannel(1, 0, 0, 2), 0.5f);
    ASSERT_TRUE(pack_occlusion(packed, occlusion, red, nullptr, error)) << error;
    EXPECT_EQ(packed.nchannels(), 1);
    ASSERT_TRUE(pack_occlusion(packed, occlusion, mask, nullptr, error)) << error;
    EXPECT_EQ(packed.getchannel(1, 0, 0, 1), 0.75f);
    EXPECT_EQ(packed.getchannel(1, 0, 0, 0), 0);
    EXPECT_EQ(packed.getchannel(1, 0, 0, 3), 0.5f);
    EXPECT_FALSE(pack_occlusion(packed, occlusion, mask, &base, error));
    EXPECT_THAT(error, HasSubstr("3 channels; a texture to pack into has 4"));
    base = image_of(3, { 1, 1, 1 });
    EXPECT_FALSE(pack_occlusion(packed, occlusion, red, &base, error));
    EXPECT_THAT(error, HasSubstr("1x1, but the map is 2x1"));
}

// The decode of docs/export.md, written out: with the light's own harmonics it gives what makelightmap does.
TEST(ExportFiles, SphericalHarmonicsDecodeToTheModelSh)
{
    const Mesh floor = scenes::floor_facing_z(2);
    VismapParams params;
    params.resolution = { 12, 12 };
    params.samples = 64;
    params.basis = "sh";
    params.order = 3;
    ImageBuf map;
    ASSERT_TRUE(make_vismap(
        map, floor, { scenes::quad({ 2.01, -9, 0 }, { 2.01, 9, 0 }, { 2.01, 9, 3 }, { 2.01, -9, 3 }) }, params));
    const ImageBuf sky
        = cfem(64, 32, [](V3d d) { return V3f(float(2 + d.y), float(1 + d.x * d.z), float(1.5 - d.x)); });
    const std::vector<ImageBuf> stack = filtered_stack(sky);
    const ImageBuf truth = lit(map, stack, model("sh"));

    // The light's numbers: integrals of L times these.
    const double pi = M_PI, band0 = 1 / (4 * pi), band1 = 3 / (4 * pi), band2 = std::sqrt(15 / (4 * pi));
    const auto numbers = [&](const V3d& w) {
        return std::array<double, 9> { band0,
                                       band1 * w.x,
                                       band1 * w.y,
                                       band1 * w.z,
                                       -band2 * w.x * w.z,
                                       band2 * w.x * w.y,
                                       std::sqrt(5 / (16 * pi)) * (3 * w.y * w.y - 1),
                                       -band2 * w.y * w.z,
                                       band2 / 2 * (w.z * w.z - w.x * w.x) };
    };
    const ImageBuf* radiance = find_radiance(stack);
    ASSERT_NE(radiance, nullptr);
    const int width = radiance->spec().width, height = radiance->spec().height;
    std::array<V3d, 9> light {};
    for (V3d& c : light)
        c = V3d(0);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double area = 2 * pi / width * (std::cos(pi * y / height) - std::cos(pi * (y + 1) / height));
            const std::array<double, 9> n = numbers(latlong::direction((x + 0.5) / width, (y + 0.5) / height));
            for (size_t i = 0; i < 9; ++i)
                for (int c = 0; c < 3; ++c)
                    light[i][c] += n[i] * area * double(radiance->getchannel(x, y, 0, c));
        }
    for (const bool is_png : { false, true }) {
        std::vector<ImageBuf> textures = sh_textures(map);
        ASSERT_EQ(textures.size(), 3u);
        for (int k = 0; k < 3 && is_png; ++k) {
            std::string png, error;
            fold_sh(textures[size_t(k)], k);
            ASSERT_TRUE(encode_png(png, textures[size_t(k)], TextureDepth::Sixteen, error)) << error;
            textures[size_t(k)] = exported_image(png, "a.png");
        }
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 12; ++x)
                for (int c = 0; c < 3; ++c) {
                    double sum = 0;
                    for (int i = 0; i < 9; ++i) {
                        double t = double(textures[size_t(i / 4)].getchannel(x, y, 0, i % 4));
                        if (is_png)
                            t = i == 0 ? t : i < 4 ? 2 * t - 1 : t - 0.5;
                        sum += t * light[size_t(i)][c];
                    }
                    EXPECT_NEAR(std::max(0.0, sum), double(truth.getchannel(x, y, 0, c)), 4e-3) << x << " " << y;
                }
    }
}

// By Bessel's inequality: what fold_sh() relies on.
TEST(ExportFiles, HarmonicsLieWithinTheirBound)
{
    VismapParams params;
    params.resolution = { 24, 24 };
    params.samples = 64;
    params.basis = "sh";
    params.order = 8;
    ImageBuf map;
    ASSERT_TRUE(make_vismap(map, scenes::sphere(V3d(0), 1, 12), { scenes::disc(V3d(0, 0, 1.5), 1, 50) }, params));
    float most = 0;
    for (int i = 0; i < 24 * 24; ++i)
        for (int c = 4; c < map.nchannels(); ++c)
            most = std::max(most, std::abs(pixels(map)[i * map.nchannels() + c]));
    EXPECT_GT(most, 0.1f);
    EXPECT_LT(most, std::sqrt(2 / (3 * float(M_PI))) + 1e-3f);
}

TEST(ExportFiles, AMapWithoutHarmonicsHasTheFirstTwoBands)
{
    const ImageBuf map = random_vismap(4, 4);
    const std::vector<ImageBuf> textures = sh_textures(map);
    ASSERT_EQ(textures.size(), 1u);
    for (int c = 0; c < 4; ++c)
        EXPECT_EQ(textures[0].getchannel(1, 2, 0, c), map.getchannel(1, 2, 0, c));
}

namespace {

tinygltf::Model gltf_of(const std::string& bytes)
{
    tinygltf::Model model;
    std::string error, warning;
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader([](auto...) { return true; }, nullptr);
    EXPECT_TRUE(loader.LoadBinaryFromMemory(
        &model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()), unsigned(bytes.size())))
        << error;
    return model;
}

ImageBuf image_in(const tinygltf::Model& model, int texture)
{
    const tinygltf::BufferView& view
        = model.bufferViews[size_t(model.images[size_t(model.textures[size_t(texture)].source)].bufferView)];
    const auto* first = reinterpret_cast<const char*>(model.buffers[0].data.data()) + view.byteOffset;
    return exported_image(std::string(first, view.byteLength), "a.png");
}

// Half of its triangles with a material, half without UVs.
Mesh painted_mesh()
{
    Mesh mesh = scenes::floor_facing_z(1);
    scenes::add_quad(mesh, V3d(2, 0, 0), V3d(3, 0, 0), V3d(3, 1, 0), V3d(2, 1, 0));
    mesh.materials.resize(1);
    mesh.materials[0].name = "paint";
    mesh.materials[0].base_color = Imath::Color4f(0.5f, 0.25f, 0.125f, 1);
    return mesh;
}

} // namespace

TEST(ExportFiles, AGltfHasItsOcclusionInside)
{
    const ImageBuf occlusion = image_of(1, { 0, 1, 0.2f, 0.8f });
    std::string bytes, error;
    int64_t cut_off = -1;
    ASSERT_TRUE(make_lit_gltf(bytes, painted_mesh(), occlusion, nullptr, {}, cut_off, error)) << error;
    const tinygltf::Model model = gltf_of(bytes);
    ASSERT_EQ(model.materials.size(), 2u);
    const tinygltf::Material &lit = model.materials[0], &plain = model.materials[1];
    EXPECT_EQ(lit.occlusionTexture.texCoord, 0);
    EXPECT_EQ(plain.occlusionTexture.index, -1); // without UVs
    EXPECT_NEAR(lit.pbrMetallicRoughness.baseColorFactor[0], 0.5, 1e-6);
    EXPECT_TRUE(model.extensionsUsed.empty());
    const ImageBuf read = image_in(model, lit.occlusionTexture.index);
    for (int x = 0; x < 4; ++x)
        EXPECT_NEAR(read.getchannel(x, 0, 0, 0), occlusion.getchannel(x, 0, 0, 0), 0.5001f / 255);
    for (const tinygltf::Primitive& part : model.meshes[0].primitives) {
        EXPECT_EQ(part.attributes.count("TEXCOORD_0"), part.material == 0 ? 1u : 0u);
        EXPECT_EQ(part.attributes.count("TEXCOORD_1"), 0u);
    }
    for (const tinygltf::BufferView& view : model.bufferViews)
        EXPECT_EQ(view.byteOffset % 4, 0u);
}

TEST(ExportFiles, AGltfSendsOutItsLight)
{
    const ImageBuf occlusion = image_of(1, { 1, 1 }), light = image_of(3, { 0.5f, 2, 4, 0.25f, 1, 0 });
    std::string bytes, error;
    int64_t cut_off = -1;
    ASSERT_TRUE(make_lit_gltf(bytes, painted_mesh(), occlusion, &light, {}, cut_off, error)) << error;
    EXPECT_EQ(cut_off, 0);
    const tinygltf::Model model = gltf_of(bytes);
    const tinygltf::Material& lit = model.materials[0];
    const double strength
        = lit.extensions.at("KHR_materials_emissive_strength").Get("emissiveStrength").GetNumberAsDouble();
    EXPECT_EQ(strength, 4);
    EXPECT_EQ(lit.emissiveTexture.texCoord, 1);
    EXPECT_EQ(lit.pbrMetallicRoughness.baseColorFactor[1], 0);
    EXPECT_EQ(lit.extensions.at("KHR_materials_specular").Get("specularFactor").GetNumberAsDouble(), 0);
    const ImageBuf read = image_in(model, lit.emissiveTexture.index);
    for (int x = 0; x < 2; ++x)
        for (int c = 0; c < 3; ++c) {
            const double v = double(read.getchannel(x, 0, 0, c));
            const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
            EXPECT_NEAR(strength * linear, double(light.getchannel(x, 0, 0, c)), 0.02);
        }
    const auto& part = model.meshes[0].primitives[0];
    EXPECT_EQ(part.attributes.at("TEXCOORD_1"), part.attributes.at("TEXCOORD_0"));

    GltfLightParams unlit;
    unlit.gltf_light = "unlit";
    ASSERT_TRUE(make_lit_gltf(bytes, painted_mesh(), occlusion, &light, unlit, cut_off, error)) << error;
    EXPECT_EQ(cut_off, 1);
    const tinygltf::Model flat = gltf_of(bytes);
    EXPECT_EQ(flat.materials[0].extensions.count("KHR_materials_unlit"), 1u);
    EXPECT_EQ(flat.materials[0].pbrMetallicRoughness.baseColorTexture.texCoord, 1);
    EXPECT_EQ(flat.materials[0].pbrMetallicRoughness.baseColorFactor[0], 1);
}

TEST(ExportFiles, AMeshWithoutUvsHasNoTextures)
{
    Mesh mesh = scenes::floor_facing_z(1);
    mesh.uvs.clear();
    std::string bytes, error;
    int64_t cut_off = 0;
    EXPECT_FALSE(make_lit_gltf(bytes, mesh, image_of(1, { 1 }), nullptr, {}, cut_off, error));
    EXPECT_EQ(error, "the mesh has no UVs");
}
