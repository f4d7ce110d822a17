// SPDX-License-Identifier: Apache-2.0
/// What is told to the listeners of MakeOptions, if there are any.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/stage/make_stage.h>

#include <cstdint>
#include <functional>
#include <string>

namespace vmlight {

/// One line to `options.say` or `options.warn`.
inline void tell(const std::function<void(const std::string&)>& listener, const std::string& line)
{
    if (listener)
        listener(line);
}

/// The progress of one step of the work, which makes an image of `width` times `height` texels.
inline Progress step(const MakeOptions& options, const char* name, int64_t width, int64_t height)
{
    return options.progress ? options.progress(name, width * height) : Progress {};
}

} // namespace vmlight
