// SPDX-License-Identifier: Apache-2.0
/// Bases: what a visibility map stores of a texel beside V and B, for shading models that read which part of the sky
/// is visible. A basis is one row of the table in bases.cpp; everything else asks the table.
#pragma once

#include <vmlight/math/harmonics.h>
#include <vmlight/math/ray_fan.h>
#include <vmlight/vismap/vismap.h>

#include <Imath/ImathVec.h>
#include <OpenImageIO/span.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// The rays of one texel, after they were traced.
struct TexelRays
{
    /// Directions around `normal`, with the density of the cosine; lane bits where nothing blocks the ray.
    const RayFan& fan;
    /// Lane bits of the rays that were traced: those above the geometric surface.
    const std::vector<uint8_t>& traced;
    /// Whether every ray of the fan was traced.
    bool complete;
    /// Unit length, object space: interpolated, and of the triangle.
    Imath::V3f normal, geometric_normal;
    /// V: the share of the traced rays that nothing blocks.
    double visibility;
    /// The factor by which B was shortened to what a surface of that V can see, 1 for most texels.
    double narrowed = 1;
    /// Of the density of the directions around `normal`, which need not be the cosine's: its harmonics are those of
    /// `normal` times this.
    double (*eigenvalue)(int band) = cosine_eigenvalue;
};

/// Turns the rays of a texel into the numbers of a basis. One per thread.
class BasisAccumulator
{
public:
    virtual ~BasisAccumulator() = default;
    /// Set `dst` to one number for each channel of the basis.
    virtual void project(const TexelRays& rays, float* dst) = 0;
};

struct VisibilityBasis
{
    /// The word for VismapParams::basis. Its channels are `<name>.<number>`.
    const char* name;
    /// What it stores, for help texts.
    const char* phrase;
    /// The parameter that only this basis reads, or "".
    const char* parameter;
    /// Whether the map must also store the normal.
    bool needs_normal;
    /// Whether the channels hold whole numbers below 2^24, so that half floats, filters and mipmaps would corrupt them.
    bool whole_numbers;
    /// Whether maps of strands can store it.
    bool has_strands;
    /// Names of the channels, in order.
    std::vector<std::string> (*channels)(const VismapParams& params);
    std::unique_ptr<BasisAccumulator> (*accumulator)(const VismapParams& params);
};

/// The table.
OIIO::cspan<VisibilityBasis> visibility_bases();
/// The basis of that name; the first, `vector`, if there is none (check_params() refuses such a name).
const VisibilityBasis& find_basis(const std::string& name);

/// Channels that `params.basis` adds.
std::vector<std::string> basis_channels(const VismapParams& params);
/// nullptr if `params.basis` adds no channels.
std::unique_ptr<BasisAccumulator> make_accumulator(const VismapParams& params);

/// Why the parameter `key` has no effect, or "": another basis reads it.
std::string unused_basis_parameter(const VismapParams& params, const std::string& key);

/// Why an image with these channels cannot be stored as half, or "".
std::string half_fault(const OIIO::ImageSpec& spec);

} // namespace vmlight
