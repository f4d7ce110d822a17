// SPDX-License-Identifier: Apache-2.0
/// Displays, views and looks of an OCIO config, and the transform from scene-linear light to one of them.
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <string>
#include <vector>

namespace vmlight::view {

/// What a user chose. Empty words are the config's defaults; no look but the view's own if `look` is "".
struct DisplayChoice
{
    std::string display, view, look;

    bool operator==(const DisplayChoice& other) const
    {
        return display == other.display && view == other.view && look == other.look;
    }
};

class DisplayConfig
{
public:
    /// Read the OCIO config `path`; "" for $OCIO. Where neither is set, a small config of our own, linear Rec.709 on an
    /// sRGB display. False, with the reason in `error`, if it cannot be read or has no display or role scene_linear.
    bool open(const std::string& path, std::string& error);

    std::vector<std::string> displays() const;
    std::vector<std::string> views(const std::string& display) const;
    std::vector<std::string> looks() const;

    /// Replace empty words by the defaults. False, with the reason in `error`, if the config lacks one of them; the
    /// error lists what it has.
    bool settle(DisplayChoice& choice, std::string& error) const;

    /// From the role scene_linear to the display, with `choice.look` in place of the view's own looks.
    /// nullptr, with the reason in `error`, if the config cannot make it.
    OCIO_NAMESPACE::ConstProcessorRcPtr processor(const DisplayChoice& choice, std::string& error) const;

    /// What changes no colour: for pictures of data.
    OCIO_NAMESPACE::ConstProcessorRcPtr no_change() const;

private:
    OCIO_NAMESPACE::ConstConfigRcPtr m_config;
};

} // namespace vmlight::view
