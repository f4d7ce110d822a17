// SPDX-License-Identifier: Apache-2.0
// OpenGL without a display.
#include "view_test.h"

#include "vmview/gl/fault.h"
#include "vmview/gl/headless.h"
#include "vmview/gl/program.h"
#include "vmview/render/renderer.h"

#include <gmock/gmock.h>

using namespace vmlight;
using namespace vmlight::view;

TEST(Headless, StartsAndStops)
{
    for (int i = 0; i < 10; ++i) {
        std::string error;
        const auto context = HeadlessContext::open(error);
        if (!context)
            GTEST_SKIP() << error;
        Renderer renderer;
        ASSERT_TRUE(renderer.build(error)) << error;
        ASSERT_EQ(gl_fault(), "");
    }
}

TEST(Headless, WrongCallsAreFound)
{
    std::string error;
    const auto context = HeadlessContext::open(error);
    if (!context)
        GTEST_SKIP() << error;
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindFramebuffer(0x1234, 0);
    EXPECT_NE(gl_fault(), "");
    EXPECT_EQ(gl_fault(), "");
}

// A driver's words are passed on.
TEST(Headless, ShadersThatAreWrongAreRefused)
{
    std::string error;
    const auto context = HeadlessContext::open(error);
    if (!context)
        GTEST_SKIP() << error;
    Program program;
    EXPECT_FALSE(program.build_whole({ "void main() { nonsense(); }" }, error));
    EXPECT_THAT(error,
                testing::AllOf(testing::HasSubstr("a shader does not compile: "), testing::HasSubstr("nonsense")));
    EXPECT_FALSE(program.build_whole(
        { "float elsewhere(); out vec4 color; void main() { color = vec4(elsewhere()); }" }, error));
    EXPECT_THAT(error, testing::HasSubstr("shaders do not link: "));
    EXPECT_FALSE(program);
}
