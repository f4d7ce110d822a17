// SPDX-License-Identifier: Apache-2.0
/// What is wrong, or doubtful, with an image file that is given as an environment.
#pragma once

#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// Check that the environment of `recipe`, whose header is `spec`, has colour channels and the shape of a lat-long map.
/// Shapes that other layouts have (6:1, 1:6, 4:3, 3:4, 1:1) are refused unless `recipe.layout` is "latlong"; maps of
/// less than 32 pixels have no shape to speak of.
///
/// @param error    set to the reason, which begins with the file's path
bool check_environment(const OIIO::ImageSpec& spec, const CfemRecipe& recipe, std::string& error);

/// Report what the environment `path` can be used with but seldom means: another shape than 2:1, integer pixels,
/// `stored` being their type in the file, and entries of a Radiance header that are not applied.
void report_doubts(const std::string& path, const OIIO::ImageSpec& spec, OIIO::TypeDesc stored,
                   const MakeOptions& options);

/// Read the environment of `recipe` whole, for those who need it unfiltered, and bring it to the working space. Reports
/// doubts and labels that contradict each other.
///
/// @param note     set to a line on its colour: "Linear Rec.709 (sRGB) -> ACEScg"
/// @returns false, with the reason in `error`, as a CFEM of that recipe would
bool read_environment(OIIO::ImageBuf& dst, const CfemRecipe& recipe, const MakeOptions& options, std::string& note,
                      std::string& error);

} // namespace vmlight
