// SPDX-License-Identifier: Apache-2.0
#include "view_test.h"

#include "temporary_folder.h"
#include "vmview/display/display_config.h"
#include "vmview/display/display_pass.h"

#include <vmlight/base/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace vmlight;
using namespace vmlight::view;

namespace OCIO = OCIO_NAMESPACE;

namespace {

using Display = DrawingTest;

constexpr int kSide = 64;

// Scene-linear colours from far below black to far above white: even ones, saturated ones, and negative channels.
std::vector<float> colours()
{
    std::vector<float> rgba;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const double light = std::exp2(-12.0 + 20.0 * x / (kSide - 1)), hue = 6.283185307 * y / kSide;
            const double chroma = (y % 4) * 0.4;
            for (int c = 0; c < 3; ++c)
                rgba.push_back(float(light * (1 + chroma * std::cos(hue + 2.0943951 * c))));
            rgba.push_back(1);
        }
    return rgba;
}

// The largest difference of what the graphics card and OCIO's CPU processor show, in steps of 8 bits.
double largest_step(const OCIO::ConstProcessorRcPtr& processor, const std::vector<float>& scene)
{
    DisplayPass pass;
    std::string error;
    EXPECT_TRUE(pass.build(processor, error)) << error;
    const Texture texture = Texture::image(kSide, kSide, GL_RGBA32F, GL_RGBA, scene.data());
    const Framebuffer target(kSide, kSide, GL_RGBA32F, false);
    target.bind();
    pass.run(texture, 1, kSide, kSide);
    std::vector<float> shown(scene.size()), wanted = scene;
    target.read(shown.data());
    OCIO::PackedImageDesc image(wanted.data(), kSide, kSide, 4);
    processor->getDefaultCPUProcessor()->apply(image);
    double largest = 0;
    for (size_t i = 0; i < shown.size(); ++i)
        if (i % 4 != 3)
            largest = std::max(largest, std::abs(double(shown[i]) - std::clamp(wanted[i], 0.0f, 1.0f)) * 255);
    return largest;
}

// Every display and view of a config, without a look and with each.
void check_all(const std::string& path, size_t least_views, double limit = 0.5)
{
    DisplayConfig config;
    std::string error;
    ASSERT_TRUE(config.open(path, error)) << error;
    std::vector<std::string> looks = config.looks();
    looks.insert(looks.begin(), "");
    size_t views = 0;
    double worst = 0;
    for (const std::string& display : config.displays())
        for (const std::string& view : config.views(display))
            for (const std::string& look : looks) {
                const DisplayChoice choice { display, view, look };
                const auto processor = config.processor(choice, error);
                ASSERT_TRUE(processor) << error;
                const double step = largest_step(processor, colours());
                worst = std::max(worst, step);
                EXPECT_LT(step, limit) << display << ", " << view << ", " << look;
                ++views;
            }
    EXPECT_GE(views, least_views * looks.size());
    ::testing::Test::RecordProperty("worst", format("{:.3g} of {}", worst, views));
}

// A curve of `size` entries, as a Resolve cube of one dimension.
std::string curve_file(int size)
{
    std::string text = format("LUT_1D_SIZE {}\nLUT_1D_INPUT_RANGE 0.0 1.0\n", size);
    for (int i = 0; i < size; ++i) {
        const double x = double(i) / (size - 1);
        text += format("{} {} {}\n", std::pow(x, 0.45), std::pow(x, 0.4), std::sqrt(x));
    }
    return text;
}

// A cube of `size` entries to the side that swaps a share of the channels.
std::string cube_file(int size, double share)
{
    std::string text = format("LUT_3D_SIZE {}\n", size);
    for (int b = 0; b < size; ++b)
        for (int g = 0; g < size; ++g)
            for (int r = 0; r < size; ++r) {
                const double x = double(r) / (size - 1), y = double(g) / (size - 1), z = double(b) / (size - 1);
                text += format("{} {} {}\n", x + share * (y * y - x), y + share * (z - y), z + share * (x * z - z));
            }
    return text;
}

} // namespace

TEST_F(Display, EveryViewOfOurConfig)
{
    check_all(VMLIGHT_TEST_OCIO, 8);
}

TEST_F(Display, PlainConfigWithoutAny)
{
    unsetenv("OCIO");
    check_all("", 2);
}

// A long curve, two cubes at once, trilinear and tetrahedral, and looks of a matrix and a cube.
TEST_F(Display, TablesAndLooks)
{
    const TemporaryFolder folder;
    folder.write("curve.cube", curve_file(2048));
    folder.write("long.cube", curve_file(16384)); // longer than a row of a texture: OCIO folds it
    folder.write("first.cube", cube_file(17, 0.2));
    folder.write("second.cube", cube_file(33, 0.5));
    const std::string path = folder.write("config.ocio", R"(ocio_profile_version: 2
search_path: "."
roles: {scene_linear: lin, default: lin}
file_rules: [!<Rule> {name: Default, colorspace: default}]
displays:
  Screen:
    - !<View> {name: Curve, colorspace: curve}
    - !<View> {name: Long curve, colorspace: long}
    - !<View> {name: Cubes, colorspace: cubes}
    - !<View> {name: Graded, colorspace: cubes, looks: "+warm, +crossed"}
looks:
  - !<Look> {name: warm, process_space: lin, transform: !<MatrixTransform> {matrix: [1.1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.8, 0, 0, 0, 0, 1]}}
  - !<Look> {name: crossed, process_space: curve, transform: !<FileTransform> {src: first.cube, interpolation: linear}}
colorspaces:
  - !<ColorSpace> {name: lin}
  - !<ColorSpace> {name: curve, from_scene_reference: !<FileTransform> {src: curve.cube, interpolation: linear}}
  - !<ColorSpace> {name: long, from_scene_reference: !<FileTransform> {src: long.cube, interpolation: linear}}
  - !<ColorSpace>
    name: cubes
    from_scene_reference: !<GroupTransform>
      children:
        - !<FileTransform> {src: curve.cube, interpolation: linear}
        - !<FileTransform> {src: first.cube, interpolation: linear}
        - !<FileTransform> {src: second.cube, interpolation: tetrahedral}
)");
    check_all(path, 4);
}

// A file may leave numbers of a transform to change in use; they keep its own values here.
TEST_F(Display, NumbersThatMayChange)
{
    const TemporaryFolder folder;
    folder.write("grade.ctf", R"(<?xml version="1.0" encoding="UTF-8"?>
<ProcessList id="grade" version="2.0">
    <ExposureContrast inBitDepth="32f" outBitDepth="32f" style="linear">
        <ECParams exposure="0.7" contrast="1.3" gamma="0.9" pivot="0.18" />
        <DynamicParameter param="EXPOSURE" />
        <DynamicParameter param="CONTRAST" />
        <DynamicParameter param="GAMMA" />
    </ExposureContrast>
    <GradingPrimary inBitDepth="32f" outBitDepth="32f" style="linear">
        <Offset rgb="0.01 -0.02 0" master="0.005" />
        <Exposure rgb="0.1 0 -0.2" master="0.3" />
        <Contrast rgb="1.1 1 0.9" master="1.05" />
        <Saturation master="1.2" />
        <DynamicParameter param="PRIMARY" />
    </GradingPrimary>
    <GradingRGBCurve inBitDepth="32f" outBitDepth="32f" style="linear">
        <Red>
            <ControlPoints>-7 -6 0 0.2 7 6.5</ControlPoints>
        </Red>
        <DynamicParameter param="RGB_CURVE" />
    </GradingRGBCurve>
</ProcessList>
)");
    check_all(folder.write("config.ocio", R"(ocio_profile_version: 2
search_path: "."
roles: {scene_linear: lin, default: lin}
file_rules: [!<Rule> {name: Default, colorspace: default}]
displays: {Screen: [!<View> {name: Graded, colorspace: graded}]}
colorspaces:
  - !<ColorSpace> {name: lin}
  - !<ColorSpace> {name: graded, from_scene_reference: !<FileTransform> {src: grade.ctf}}
)"),
              1);
}

TEST_F(Display, ExposureIsAFactor)
{
    DisplayConfig config;
    std::string error;
    ASSERT_TRUE(config.open(VMLIGHT_TEST_OCIO, error)) << error;
    DisplayChoice choice;
    ASSERT_TRUE(config.settle(choice, error)) << error;
    DisplayPass pass;
    ASSERT_TRUE(pass.build(config.processor(choice, error), error)) << error;
    std::vector<float> dark = colours(), shown[2];
    std::vector<float> bright = dark;
    for (size_t i = 0; i < bright.size(); ++i)
        bright[i] *= i % 4 == 3 ? 1 : 4;
    const Framebuffer target(kSide, kSide, GL_RGBA32F, false);
    for (int k = 0; k < 2; ++k) {
        const Texture scene = Texture::image(kSide, kSide, GL_RGBA32F, GL_RGBA, k ? bright.data() : dark.data());
        target.bind();
        pass.run(scene, k ? 1.0f : 4.0f, kSide, kSide);
        shown[k].resize(dark.size());
        target.read(shown[k].data());
    }
    EXPECT_EQ(shown[0], shown[1]);
}

TEST_F(Display, RefusesWhatTheConfigLacks)
{
    DisplayConfig config;
    std::string error;
    ASSERT_TRUE(config.open(VMLIGHT_TEST_OCIO, error)) << error;
    DisplayChoice choice { "", "Nonsense", "" };
    EXPECT_FALSE(config.settle(choice, error));
    EXPECT_NE(error.find("the OCIO config has no view \"Nonsense\"; it has \""), std::string::npos) << error;
    const TemporaryFolder folder;
    const std::string head = "ocio_profile_version: 2\nfile_rules: [!<Rule> {name: Default, colorspace: lin}]\n"
                             "colorspaces: [!<ColorSpace> {name: lin}]\n";
    error.clear();
    EXPECT_FALSE(config.open(folder.write("dark.ocio", head + "roles: {scene_linear: lin}\n"), error));
    EXPECT_NE(error.find("dark.ocio\": the OCIO config has no display"), std::string::npos) << error;
    const std::string screen = "displays: {Screen: [!<View> {name: Raw, colorspace: lin}]}\n";
    error.clear();
    EXPECT_FALSE(config.open(folder.write("roles.ocio", head + screen + "roles: {default: lin}\n"), error));
    EXPECT_NE(error.find("roles.ocio\": the OCIO config has no role scene_linear"), std::string::npos) << error;
    EXPECT_FALSE(config.open("/nowhere/config.ocio", error));
    EXPECT_EQ(error.find("\"/nowhere/config.ocio\": "), 0u) << error;
}
