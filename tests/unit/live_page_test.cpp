// SPDX-License-Identifier: Apache-2.0
// The live page of vmcost's report: which meshes have none, and what the report says then.
#include "pose_scenes.h"

#include <vmcost/live_page.h>
#include <vmcost/report.h>

#include <gmock/gmock.h>

using namespace vmlight;
using testing::HasSubstr;
using testing::Not;

TEST(LivePage, MeshesThatABrowserWouldOpenSlowlyHaveNone)
{
    Mesh mesh = scenes::floor_facing_z(1);
    mesh.positions.resize(500000, mesh.positions[0]);
    mesh.normals.resize(500000, mesh.normals[0]);
    mesh.uvs.resize(500000, mesh.uvs[0]);
    std::string html = "before", error;
    cost::Inputs inputs;
    inputs.scene = scenes::scene_of(mesh);
    ASSERT_TRUE(cost::make_live_page(html, inputs, {}, {}, {}, {}, error)) << error;
    EXPECT_EQ(html, "");
}

TEST(LivePage, TheReportShowsItOrSaysWhyNot)
{
    cost::Report report;
    EXPECT_THAT(cost::report_html(report), HasSubstr("too large to be shown live"));
    report.live_page = "<p title=\"a\">";
    EXPECT_THAT(cost::report_html(report), HasSubstr("srcdoc=\"&lt;p title=&quot;a&quot;&gt;\""));
    EXPECT_THAT(cost::report_html(report), Not(HasSubstr("too large")));
}
