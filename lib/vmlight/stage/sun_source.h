// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/stage/pixel_source.h>

#include <string>

namespace vmlight {

/// What a source of a filtered environment that was split into suns and a rest implements as well.
class SunSource
{
public:
    virtual ~SunSource() = default;

    /// Set `text` to suns_text() of the suns, "" if there are none. Any thread. False, with the reason in `error`, if
    /// the environment cannot be read.
    virtual bool find_suns(std::string& text, std::string& error) = 0;
};

/// The suns of a filtered environment, from a recipe or from the metadata of a file: see SunSource::find_suns(). False
/// too if the file says that there are some, but not which.
bool find_suns(std::string& text, PixelSource& cfem, std::string& error);

} // namespace vmlight
