// SPDX-License-Identifier: Apache-2.0
/// Visibility maps of strands in memory, for tests.
#pragma once

#include "strand_files.h"

#include <vmlight/vismap/strand_map.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vmlight::strand_bake {

inline VismapParams rays(int samples)
{
    VismapParams params;
    params.samples = samples;
    return params;
}

inline OIIO::ImageBuf strand_map(const Strands& strands, const std::vector<Mesh>& occluders, const VismapParams& params,
                                 int texels = 8, int nthreads = 1)
{
    StrandScene scene;
    StrandLayout layout;
    std::string error;
    OIIO::ImageBuf map;
    int64_t traced = 0;
    StrandParams own;
    own.strand_texels = texels;
    EXPECT_TRUE(check_strands(strands, error)) << error;
    EXPECT_TRUE(scene.build(strands, occluders, 1, error)) << error;
    EXPECT_TRUE(StrandLayout::make(layout, strands.count(), texels, error)) << error;
    const StrandBaker baker(strands, scene, layout, params);
    EXPECT_TRUE(make_strand_map(map, describe_strand_map(strands, layout, own, params), baker, nthreads, traced))
        << map.geterror();
    EXPECT_EQ(traced, int64_t(strands.count()) * texels * params.samples);
    return map;
}

} // namespace vmlight::strand_bake
