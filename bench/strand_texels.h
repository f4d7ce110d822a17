// SPDX-License-Identifier: Apache-2.0
/// Strands on a body, and some texels of their map: what benches of strands begin with.
#pragma once

#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/mesh/import/strands/read_strands.h>
#include <vmlight/mesh/strand_curve.h>
#include <vmlight/vismap/strand_map.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vmlight {

struct StrandTexels
{
    struct Texel
    {
        int x, y;
        int64_t strand;
        CurvePoint point;
    };

    /// Every `step`-th texel of 16 a strand. False, with the reason in `error`, if a file cannot be read or traced.
    bool read(const std::string& hair, const std::string& radius, const std::string& body, int64_t step,
              std::string& error)
    {
        if (!read_strands(strands, hair, {}, radius, error) || !read_mesh(bodies[0], body, {}, error)
            || !scene.build(strands, bodies, 0, error) || !StrandLayout::make(layout, strands.count(), 16, error))
            return false;
        for (int64_t i = 0; i < layout.strands * layout.texels; i += step) {
            const int64_t strand = i / layout.texels;
            const int x = int(strand / layout.rows) * layout.texels + int(i % layout.texels);
            texels.push_back(
                { x, int(strand % layout.rows), strand, StrandCurve(strands, size_t(strand)).at(layout.share_at(x)) });
        }
        return true;
    }

    Strands strands;
    std::vector<Mesh> bodies { 1 };
    StrandScene scene;
    StrandLayout layout;
    std::vector<Texel> texels;
};

} // namespace vmlight
