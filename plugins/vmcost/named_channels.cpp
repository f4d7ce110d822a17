// SPDX-License-Identifier: Apache-2.0
#include "named_channels.h"

#include <vmlight/base/format.h>
#include <vmlight/image/image_file.h>

#include <OpenImageIO/imagebufalgo.h>

namespace vmlight::cost {

bool read_channels(OIIO::ImageBuf& dst, const std::string& path, const std::vector<std::string>& names,
                   std::string& error)
{
    OIIO::ImageBuf read;
    if (!read_image(read, path, error))
        return false;
    std::vector<int> order;
    for (const std::string& name : names) {
        order.push_back(read.spec().channelindex(name));
        if (order.back() < 0) {
            error = format("\"{}\": no channel {}", path, name);
            return false;
        }
    }
    dst = OIIO::ImageBufAlgo::channels(read, int(names.size()), order, {}, names);
    return true;
}

} // namespace vmlight::cost
