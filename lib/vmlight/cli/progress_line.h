// SPDX-License-Identifier: Apache-2.0
/// How far a step of the work is, how fast it goes and how long it will take, on stderr.
#pragma once

#include <vmlight/base/progress.h>

#include <cstdint>
#include <functional>
#include <string>

namespace vmlight {

/// "bake  43 %  310 k texels/s  00:12 left"; at the end "bake 100 %  310 k texels/s  00:21". A time not yet known is
/// "--:--".
///
/// @param done     the share of the step, in [0, 1]
/// @param seconds  since the step began
/// @param texels   of the whole image that the step makes, covered or not
std::string progress_line(const std::string& step, double done, double seconds, int64_t texels);

/// A Progress that tells of itself on stderr: one line that is written anew ten times a second on a terminal, else a
/// line for each tenth of a step that takes more than a second. It goes on while `goes_on()` is true.
Progress progress_on_stderr(const std::string& step, int64_t texels, std::function<bool()> goes_on);

/// End a line that is still being written anew, before something else is told.
void end_progress_line();

} // namespace vmlight
