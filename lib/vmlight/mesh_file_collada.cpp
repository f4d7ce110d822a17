// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh_file_collada.h>

#include <OpenImageIO/strutil.h>

namespace vmlight {

std::string collada_fault(const std::string& text)
{
    constexpr int kDeepest = 100000; // twice as deep fits the stack that meshes are read on
    int depth = 0;
    for (size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
        const bool is_comment = text.compare(at, 4, "<!--") == 0;
        const size_t end = text.find(is_comment ? "-->" : ">", at);
        if (end == std::string::npos)
            break;
        const char kind = text[at + 1];
        if (kind == '/')
            --depth;
        else if (kind != '!' && kind != '?' && text[end - 1] != '/' && ++depth > kDeepest)
            return OIIO::Strutil::fmt::format("its elements are more than {} deep", kDeepest);
        at = end;
    }
    return "";
}

} // namespace vmlight
