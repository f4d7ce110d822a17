// SPDX-License-Identifier: Apache-2.0
/// What a file's own metadata say about its colour, and whether they can be believed.
#pragma once

#include <vmlight/image/primaries.h>

#include <OpenImageIO/imageio.h>

#include <string>
#include <vector>

namespace vmlight {

/// Labels of a file. `oiio:ColorSpace` is none of them: readers set it by format, whatever the file says.
struct ColorLabels
{
    /// `colorInteropID`, or that of an ACES container; "" if there is none or it is "unknown".
    std::string interop_id;
    /// The space of the `chromaticities`, or nullptr. Those of integer pixels say nothing of their curve.
    const LinearSpace* primaries = nullptr;
    /// The `chromaticities` as text, if they are of no known space.
    std::string unknown_primaries;
    /// The flag with which oiiotool or maketx converted the pixels, or "": see converting_flag().
    std::string converted_by;
};

/// @param stored   pixel type in the file
ColorLabels read_color_labels(const OIIO::ImageSpec& spec, OIIO::TypeDesc stored);

/// 8 or 16 bit integers, as in PNG.
bool is_integer(OIIO::TypeDesc stored);

/// False, with what to do in `error`, if a program converted the pixels of the file `path` after it was labelled. (Both
/// OIIO 2 and 3 keep the source's labels.)
bool check_label(const ColorLabels& labels, const std::string& path, std::string& error);

/// Add a warning if `colorInteropID` and `chromaticities` contradict each other. `taken` names what is believed.
void add_contradiction(std::vector<std::string>& warnings, const ColorLabels& labels, const std::string& taken);

/// A warning that `chromaticities` of no known space are ignored.
std::string unknown_primaries_text(const ColorLabels& labels);

/// The flag of oiiotool or maketx that converted the colour of an image, as its history tells, or "".
std::string converting_flag(const OIIO::ImageSpec& spec);

} // namespace vmlight
