// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vmlight {

/// Exit codes of all executables.
enum class ExitCode
{
    Done = 0,
    Failed = 1,
    Usage = 2
};

} // namespace vmlight
