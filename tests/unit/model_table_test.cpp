// SPDX-License-Identifier: Apache-2.0
// Each row of the tables of shading models and bases keeps its promises, a new one too.
#include "scenes.h"
#include "stack_maps.h"

#include <vmlight/lightmap/model.h>
#include <vmlight/lightmap/model_light.h>
#include <vmlight/lightmap/shader.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/basis.h>

#include <set>

using namespace vmlight;
using namespace scene;

namespace {

VismapParams bake_of(const ModelEntry& model)
{
    VismapParams params;
    params.resolution = { 8, 8 };
    params.samples = 16;
    if (*model.basis)
        params.basis = model.basis;
    if (*model.added_channel)
        params.channels = { model.added_channel };
    return params;
}

} // namespace

TEST(ModelTable, NamesAndRanksAreUniqueAndPhrasesAreShort)
{
    std::set<std::string> names { "auto" };
    std::set<int> ranks;
    for (const ModelEntry& model : model_entries()) {
        EXPECT_TRUE(names.insert(model.name).second) << model.name;
        EXPECT_TRUE(model.rank == 0 || ranks.insert(model.rank).second) << model.name;
        EXPECT_TRUE(*model.phrase && std::string(model.phrase).size() < 70) << model.name;
        EXPECT_EQ(find_model_entry(model.name), &model);
    }
    EXPECT_EQ(find_model_entry("auto"), nullptr);
    EXPECT_EQ(model_choices().choices.size(), names.size());
}

TEST(ModelTable, EachModelShadesTheMapThatItsRowBakes)
{
    const ImageBuf env = cfem(16, 8, [](V3d w) { return V3f(float(1 + 0.5 * w.y)); });
    for (const ModelEntry& model : model_entries()) {
        ImageBuf vm, image;
        ASSERT_TRUE(make_vismap(vm, scenes::floor_facing_z(1), {}, bake_of(model))) << vm.geterror();
        std::vector<ImageBuf> light;
        std::string error;
        CfemParams small;
        small.resolution = { 16, 8 };
        ASSERT_TRUE(make_model_light(light, env, small, model.light, error)) << error;
        LightmapParams params;
        params.model = model.name;
        EXPECT_TRUE(make_lightmap(image, vm, light, params)) << model.name << ": " << image.geterror();

        ShadingModel chosen;
        ASSERT_TRUE(choose_model(chosen, params, vm.spec(), true, error)) << error;
        EXPECT_EQ(chosen.entry, &model);
        int whole = 0;
        for (const std::string& channel : chosen.channels)
            whole += holds_whole_numbers(channel);
        EXPECT_EQ(whole, model.whole_numbers) << model.name;
        // The best model of a map is the one that it was baked for.
        params.model = "auto";
        ASSERT_TRUE(choose_model(chosen, params, vm.spec(), true, error)) << error;
        EXPECT_TRUE(!*model.basis || chosen.name == model.name) << chosen.name;
    }
}

TEST(BasisTable, EachBasisFillsItsChannels)
{
    std::set<std::string> names;
    for (const VisibilityBasis& basis : visibility_bases()) {
        EXPECT_TRUE(names.insert(basis.name).second) << basis.name;
        EXPECT_TRUE(*basis.phrase && std::string(basis.phrase).size() < 80) << basis.name;
        VismapParams params;
        params.resolution = { 8, 8 };
        params.samples = 16;
        params.basis = basis.name;
        ImageBuf vm;
        ASSERT_TRUE(make_vismap(vm, scenes::floor_facing_z(1), {}, params)) << vm.geterror();
        const size_t fixed = basis.needs_normal ? 7 : 4, added = basis_channels(params).size();
        EXPECT_EQ(size_t(vm.nchannels()), fixed + added);
        EXPECT_EQ(added > 0, basis.accumulator != nullptr);
        for (size_t c = fixed; c < fixed + added; ++c) {
            const std::string& channel = vm.spec().channelnames[c];
            EXPECT_EQ(channel.find(std::string(basis.name) + "."), 0u);
            EXPECT_EQ(holds_whole_numbers(channel), basis.whole_numbers);
        }
    }
    EXPECT_EQ(basis_choices().choices.size(), names.size());
}

TEST(BasisTable, AParameterOfAnotherBasisIsUnused)
{
    VismapParams params;
    EXPECT_EQ(unused_basis_parameter(params, "order"), "only the basis sh uses it");
    EXPECT_EQ(unused_basis_parameter(params, "samples"), "");
    params.basis = "sh";
    EXPECT_EQ(unused_basis_parameter(params, "order"), "");
}

TEST(BasisTable, WholeNumbersAreRefusedAsHalfThoughTheyWouldFit)
{
    for (const char* channel : { "mask.0", "cells.11" }) {
        OIIO::ImageSpec spec(8, 8, 5, OIIO::TypeFloat);
        spec.channelnames[4] = channel;
        EXPECT_EQ(half_fault(spec),
                  std::string("channel ") + channel
                      + " holds whole numbers up to 2^24, and half is exact only up to 2048: write float");
    }
    EXPECT_EQ(half_fault(describe_vismap("", {})), "");
}
