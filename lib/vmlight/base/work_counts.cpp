// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/work_counts.h>

namespace vmlight {

WorkCounts& work_counts()
{
    static WorkCounts counts;
    return counts;
}

} // namespace vmlight
