// SPDX-License-Identifier: Apache-2.0
/// The scene-linear spaces that vmlight knows without a config: their names, primaries, and the matrices between them.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace vmlight {

struct LinearSpace
{
    const char* interop_id;
    /// The interop id, and the space's names in old and new OCIO configs.
    std::vector<const char*> names;
    /// xy of red, green, blue and white, as an EXR stores them.
    std::array<float, 8> chromaticities;
};

/// Rec.709, P3-D65, Rec.2020, AP0, AP1 and CIE XYZ of a D65 white. XYZ has the chromaticities of the axes and of the
/// white E, as OpenEXR writes them.
const std::vector<LinearSpace>& linear_spaces();

/// The space with the id or name `name`, ignoring case, or nullptr.
const LinearSpace* linear_space_named(const std::string& name);

/// The space with these chromaticities, to about three digits, or nullptr.
const LinearSpace* linear_space_with(const std::array<float, 8>& chromaticities);

/// The matrix, row by row, from one space to another: through CIE XYZ, with Bradford's adaptation of the white, as OCIO
/// configs have it. White stays white.
std::array<double, 9> matrix_between(const LinearSpace& from, const LinearSpace& to);

/// The luminance Y of one unit of each of a space's primaries; their sum is 1.
std::array<double, 3> luminance_of_primaries(const LinearSpace& space);

} // namespace vmlight
