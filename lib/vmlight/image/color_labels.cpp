// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/color_labels.h>

#include <vmlight/base/format.h>
#include <vmlight/image/color_space.h>

#include <algorithm>
#include <array>

namespace vmlight {

ColorLabels read_color_labels(const OIIO::ImageSpec& spec, OIIO::TypeDesc stored)
{
    ColorLabels labels;
    labels.interop_id = spec.get_string_attribute("colorInteropID");
    if (labels.interop_id.empty() && spec.get_int_attribute("acesImageContainerFlag"))
        labels.interop_id = "lin_ap0_scene";
    if (is_any_of(labels.interop_id, { "unknown" }))
        labels.interop_id.clear();
    labels.converted_by = converting_flag(spec);
    const OIIO::ParamValue* stored_xy = spec.find_attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
    if (!stored_xy || is_integer(stored))
        return labels;
    std::array<float, 8> xy;
    std::copy_n(static_cast<const float*>(stored_xy->data()), xy.size(), xy.begin());
    labels.primaries = linear_space_with(xy);
    if (!labels.primaries)
        labels.unknown_primaries = format("red {:g} {:g}, green {:g} {:g}, blue {:g} {:g}, white {:g} {:g}", xy[0],
                                          xy[1], xy[2], xy[3], xy[4], xy[5], xy[6], xy[7]);
    return labels;
}

bool is_integer(OIIO::TypeDesc stored)
{
    const auto type = static_cast<OIIO::TypeDesc::BASETYPE>(stored.basetype);
    return type == OIIO::TypeDesc::UINT8 || type == OIIO::TypeDesc::INT8 || type == OIIO::TypeDesc::UINT16
        || type == OIIO::TypeDesc::INT16;
}

bool check_label(const ColorLabels& labels, const std::string& path, std::string& error)
{
    if (labels.converted_by.empty())
        return true;
    const std::string label = labels.interop_id.empty()
        ? format("chromaticities of {}", labels.primaries ? labels.primaries->interop_id : "another space")
        : format("colorInteropID \"{}\"", labels.interop_id);
    error = format("\"{}\": its Software attribute shows a colour conversion ({}), which leaves the {} of the image "
                   "before; set --colorspace (--albedo-colorspace) to the space that it was converted to",
                   path, labels.converted_by, label);
    return false;
}

void add_contradiction(std::vector<std::string>& warnings, const ColorLabels& labels, const std::string& taken)
{
    const LinearSpace* label = linear_space_named(labels.interop_id);
    const bool has_primaries = labels.primaries || !labels.unknown_primaries.empty();
    if (label && has_primaries && label != labels.primaries)
        warnings.push_back(format(
            "its colorInteropID says {}, but its chromaticities are those of {}: taken as {}", labels.interop_id,
            labels.primaries ? labels.primaries->interop_id : "no known space (" + labels.unknown_primaries + ")",
            taken));
}

std::string unknown_primaries_text(const ColorLabels& labels)
{
    return format("its chromaticities ({}) match no known space and are ignored", labels.unknown_primaries);
}

std::string converting_flag(const OIIO::ImageSpec& spec)
{
    // oiiotool and maketx of OIIO 2 record the whole command line.
    for (const char* attribute : { "Software", "Exif:ImageHistory" }) {
        const std::string history = spec.get_string_attribute(attribute);
        for (const char* flag :
             { "--colorconvert", "--tocolorspace", "--ociodisplay", "--ociolook", "--ociofiletransform", "--ccmatrix" })
            if (history.find(flag) != std::string::npos)
                return flag;
    }
    return "";
}

} // namespace vmlight
