// SPDX-License-Identifier: Apache-2.0
// OpenGL without a display.
#include "view_test.h"

#include "vmview/gl/fault.h"
#include "vmview/gl/headless.h"
#include "vmview/render/renderer.h"

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
