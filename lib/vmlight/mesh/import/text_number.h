// SPDX-License-Identifier: Apache-2.0
/// Numbers in the text of mesh files, whatever the locale.
#pragma once

#include <OpenImageIO/string_view.h>

namespace vmlight {

struct TextNumber
{
    double value = 0; ///< nearest to the text
    /// Within two units in the last place of the text: rounded in the same steps as assimp 5.2 does, so that meshes
    /// stay what they were, bit for bit, when assimp read their formats.
    float rounded = 0;
};

/// Infinity beyond what a float holds.
float nearest_float(double value);

/// The number that `word` is, all of it: with or without a sign, digits before the point or behind it, an exponent;
/// "nan" and "inf" in any case, "1.#QNAN" and "1.#INF" of old C libraries; a comma as the decimal point.
/// @returns false if it is anything else
bool parse_number(OIIO::string_view word, TextNumber& number);

} // namespace vmlight
