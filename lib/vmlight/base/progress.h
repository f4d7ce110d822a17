// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace vmlight {

/// Called from any thread, but never from two at once, with the fraction of the work that is done, in [0, 1]. Return
/// false to stop: the stage then fails with the message "interrupted".
using Progress = std::function<bool(double done)>;

/// Goes from `first` to `last` of `whole`, which must outlive it. Empty if nobody listens.
inline Progress part_of(const Progress& whole, double first, double last)
{
    if (!whole)
        return {};
    return [&whole, first, last](double done) { return whole(first + (last - first) * done); };
}

/// Called when a step of the work begins that is not worth a Progress of its own, with its name. May be empty.
using StepListener = std::function<void(const char* step)>;

/// Say that `step` begins, to who listens.
inline void begin_step(const StepListener& listener, const char* step)
{
    if (listener)
        listener(step);
}

} // namespace vmlight
