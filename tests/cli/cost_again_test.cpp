// SPDX-License-Identifier: Apache-2.0
// vmcost run again: what it reuses, and what it measures anew.
#include "cost_run.h"

#include <vmlight/base/oiio_compat.h>

#include <OpenImageIO/strutil.h>

using namespace vmlight;
using OIIO::ImageBuf;
using OIIO::Strutil::replace;
using OIIO::Strutil::starts_with;
using testing::HasSubstr;
using testing::Not;

namespace {

using CostAgain = CostTest;

} // namespace

TEST_F(CostAgain, RowsAreMeasuredOnceAndAnewWhenAnInputChanges)
{
    cost("checker.exr" + small);
    const int count = measured;
    const auto before = rows();
    cost("checker.exr" + small);
    expect_counts(0, count);
    EXPECT_EQ(rows(), before);
    cost("checker.exr sky.exr" + small);
    expect_counts(count, count);
    write("roof.obj", replace(kQuad, " 0\nv", " 0.5\nv"));
    for (const char* flag : { " --resolution 17", " --occluder roof.obj", " --up z" }) {
        cost("checker.exr" + small + flag);
        expect_counts(count, 0, flag);
    }
    make_sky({ 3, 2, 1 }, "checker.exr");
    cost("checker.exr" + small);
    expect_counts(count, 0, "another picture of the same name");
}

TEST_F(CostAgain, ALostHeatMapIsMadeAgain)
{
    cost("sky.exr" + small);
    const int count = measured;
    remove("report/error_sky_paper.exr");
    remove("report/error_sky_lobe.png");
    cost("sky.exr" + small);
    expect_counts(2, count - 2);
}

TEST_F(CostAgain, TheSamePixelsInAnotherFrameAreAnotherLight)
{
    make_sky({ 1, 2, 3 }, "sky.exr", 8, 4);
    cost("sky.exr" + small);
    const int count = measured;
    make_sky({ 1, 2, 3 }, "sky.exr", 4, 8);
    cost("sky.exr" + small);
    expect_counts(count, 0, "upright");

    const auto write_sky = [&](const char* what, OIIO::ImageSpec spec) {
        ImageBuf sky(spec);
        OIIO::ImageBufAlgo::fill(sky, { 1.0f, 2.0f, 3.0f });
        ASSERT_TRUE(sky.write(path("sky.exr"))) << sky.geterror();
        cost("sky.exr" + small);
        expect_counts(count, 0, what);
    };
    OIIO::ImageSpec half(8, 4, 3, OIIO::TypeFloat);
    half.full_width = 16;
    write_sky("half of a display window", half);
    // As maketx --envlatl writes them.
    ImageBuf sky(OIIO::ImageSpec(8, 4, 3, OIIO::TypeFloat));
    OIIO::ImageBufAlgo::fill(sky, { 1.0f, 2.0f, 3.0f });
    ASSERT_TRUE(OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxEnvLatl, sky, path("sky.exr"),
                                                 OIIO::ImageSpec(8, 4, 3, OIIO::TypeFloat)))
        << OIIO::geterror();
    cost("sky.exr" + small);
    expect_counts(count, 0, "an environment texture");
}

TEST_F(CostAgain, SpoiltFilesOfAReportAreMadeAgain)
{
    cost("checker.exr" + small);
    const int count = measured;
    const std::string heat_map = read("report/error_checker_lobe.exr");
    write("report/error_checker_lobe.exr", heat_map.substr(0, heat_map.size() - 40));
    EXPECT_THAT(cost("checker.exr" + small), HasSubstr("checker: reused the reference"));
    expect_counts(1, count - 1);
    EXPECT_TRUE(read("report/error_checker_lobe.exr") == heat_map);

    const auto references = names("reference_", "report");
    ASSERT_EQ(references.size(), 1u);
    const std::string reference = "report/" + references[0], traced = read(reference);
    const auto expect_traced_again = [&](const char* damage) {
        EXPECT_THAT(cost("checker.exr" + small), Not(HasSubstr("reused the reference"))) << damage;
        EXPECT_TRUE(read(reference) == traced) << damage;
    };
    const auto spoil = [&](const char* damage, const std::function<ImageBuf(const ImageBuf&)>& edit) {
        ImageBuf whole(path(reference));
        ASSERT_TRUE(whole.read(0, 0, true)) << whole.geterror();
        ASSERT_TRUE(edit(whole).write(path(reference)));
        expect_traced_again(damage);
    };
    spoil("another size", [](const ImageBuf& whole) {
        ImageBuf small;
        oiio::resize(small, whole, OIIO::ROI(0, 8, 0, 8), 0);
        return small;
    });
    spoil("half of it", [](const ImageBuf& whole) { return OIIO::ImageBufAlgo::crop(whole, OIIO::ROI(0, 16, 0, 8)); });
    write(reference, traced.substr(0, traced.size() - 40));
    expect_traced_again("cut short");
}
