// SPDX-License-Identifier: Apache-2.0
/// Progress on stderr: percent, rate and time left of one step of the work.
#pragma once

#include <vmlight/base/progress.h>

#include <cstdint>
#include <functional>
#include <string>

namespace vmlight {

/// "bake  43 %  310 k texels/s  00:12 left"; at the end "bake 100 %  310 k texels/s  00:21". An unknown time is
/// "--:--".
///
/// @param done     fraction of the step that is done, in [0, 1]
/// @param seconds  since the step started
/// @param texels   in the whole image, covered or not; 0 if the step makes none, which has no rate
std::string progress_line(const std::string& step, double done, double seconds, int64_t texels);

/// A Progress that prints on stderr: on a terminal one line, updated ten times a second; otherwise a line every 10 % of
/// a step that takes more than a second. The work continues while `keep_going()` is true.
Progress progress_on_stderr(const std::string& step, int64_t texels, std::function<bool()> keep_going);

/// End a progress line that is still being updated, before something else is printed.
void end_progress_line();

} // namespace vmlight
