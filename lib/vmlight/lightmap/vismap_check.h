// SPDX-License-Identifier: Apache-2.0
/// Whether the texels of a stored visibility map are still those of surfaces: filters that ring, lossy compression and
/// colour conversions leave no other trace.
#pragma once

#include <vmlight/base/bad_values.h>

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vmlight {

/// Texels of a region that no surface has, and where the first is.
struct VismapDoubts
{
    /// Where V or B is not 0.
    int64_t texels = 0;
    /// V outside [0, 1] or |B| > V, beyond the rounding of half floats. Means of texels keep both, so that no box
    /// filter makes one. Measured on ten maps as float, half, pxr24, dwaa, dwab and box-filtered down to 1/32: none.
    /// After one reduction to a half by mitchell, catmull-rom, lanczos or sinc: 2 to 30 %, but down to 0.04 % where the
    /// map is so smooth that they ring by less than 1 %; b44 on half: up to 3 %.
    BadValues impossible;
    /// Texels with V > 0.4, and those of them with |B| < 2/3 - (1 - V), as no point of a surface has it: what is hidden
    /// weighs 1 - V. Means have it where normals differ. Measured on the same maps: at most 5 % as baked, 10 % at 1/4,
    /// 32 % at 1/16, 67 % at 1/32; 33 to 80 % after Rec.709 to ACEScg, 97 to 100 % after sRGB to linear.
    int64_t bright = 0, too_short = 0;

    void merge(const VismapDoubts& other);
};

/// Count the texels of `roi`.
///
/// @param texels   the first texel; each has `channels` floats, and the texels of `roi` follow one another
/// @param index    of V and the three of B among them
void count_doubts(VismapDoubts& dst, OIIO::ROI roi, const float* texels, int channels, const std::array<int, 4>& index);

/// Why a map or a tile of it is refused, or "": more than one in a thousand of its texels are impossible. `stored` is
/// as in the file, for the likely cause.
std::string impossible_fault(const VismapDoubts& doubts, const OIIO::ImageSpec& stored);

/// Check a whole map once, before it lights anything.
///
/// @param map      a visibility map of floats in memory
/// @param stored   as in the file, with its pixel type and compression
/// @param warnings set to what is odd about a map that is not refused
/// @returns false, with the reason in `error`, if impossible_fault() gives one, or |B| is too short in 90 %
///          of the texels with V > 0.4.
bool check_vismap(const OIIO::ImageBuf& map, const OIIO::ImageSpec& stored, int nthreads,
                  std::vector<std::string>& warnings, std::string& error);

} // namespace vmlight
