// SPDX-License-Identifier: Apache-2.0
/// Runs of vmframes on an open quad.
#pragma once

#include "command_test.h"

#include <string>

namespace vmlight {

class VmframesTest : public CommandTest
{
protected:
    VmframesTest()
    {
        write("quad.obj", kQuad);
        make_sky({ 1, 2, 3 });
    }
    /// Of all channels and pixels.
    double mean(const std::string& name) const
    {
        double sum = 0;
        const Pixels all = pixels(name);
        for (const float value : all.values)
            sum += double(value);
        return sum / double(all.values.size());
    }
    const std::string few = " --size 16 --spp 4", small = few + " --resolution 16 --samples 4 --cfem-resolution 16";
};

} // namespace vmlight
