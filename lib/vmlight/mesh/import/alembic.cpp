// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/alembic.h>

#include <OpenImageIO/strutil.h>

namespace vmlight {
namespace {

const char* const kOgawa = "Ogawa";
const char* const kHdf5 = "\x89HDF\r\n\x1a\n";

} // namespace

bool is_alembic(const FileHead& head)
{
    return OIIO::Strutil::starts_with(head.bytes, kOgawa) || OIIO::Strutil::starts_with(head.bytes, kHdf5);
}

std::string alembic_fault(const FileHead& head)
{
    if (OIIO::Strutil::starts_with(head.bytes, kHdf5))
        return "stored as HDF5, which is not read: make it an Ogawa file with \"abcconvert -toOgawa OLD.abc NEW.abc\", "
               "or export it again";
    if (!OIIO::Strutil::starts_with(head.bytes, kOgawa))
        return "not an Alembic file: it starts neither as Ogawa nor as HDF5";
    constexpr char kFinished = '\xff';
    if (head.bytes.size() > 5 && head.bytes[5] != kFinished)
        return "an Alembic file that was never finished: export it again";
    return "";
}

} // namespace vmlight
