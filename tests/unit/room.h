// SPDX-License-Identifier: Apache-2.0
/// A room of a floor, a wall and a lid, of two materials and two nodes.
#pragma once

#include <vmlight/stage/make_stage.h>

#include <gtest/gtest.h>

#include <string>

namespace vmlight {

/// Floor: material Stone, node Ground, the lower left quarter of UV space. Wall: Brick, House, lower right. Lid: Stone,
/// House, upper left. With `is_stacked` all three cover the lower left quarter.
inline std::string room_obj(bool is_stacked = false)
{
    const std::string first = "vt 0 0\nvt 0.5 0\nvt 0.5 0.5\nvt 0 0.5\n";
    return "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 1 -1 2\nv 1 1 2\nv -1 -1 2\nv -1 1 2\n" + first
        + (is_stacked ? first + first
                      : "vt 0.5 0\nvt 1 0\nvt 1 0.5\nvt 0.5 0.5\nvt 0 0.5\nvt 0.5 0.5\nvt 0.5 1\nvt 0 1\n")
        + "vn 0 0 1\nvn -1 0 0\nvn 0 0 -1\no Ground\nusemtl Stone\nf 1/1/1 2/2/1 3/3/1 4/4/1\n"
          "o House\nusemtl Brick\nf 2/5/2 5/6/2 6/7/2 3/8/2\nusemtl Stone\nf 7/9/3 8/10/3 6/11/3 5/12/3\n";
}

/// Why a bake is refused.
inline std::string refusal(const VismapRecipe& recipe)
{
    OIIO::ImageBuf image;
    EXPECT_FALSE(make_image(image, recipe));
    return image.geterror();
}

} // namespace vmlight
