// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/alembic/ogawa.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/alembic/error.h>

#include <OpenImageIO/filesystem.h>

namespace vmlight::alembic {

OgawaFile::OgawaFile(const std::string& path)
{
    OIIO::Filesystem::open(m_file, path, std::ios::in | std::ios::binary);
    if (!m_file)
        throw Error("cannot be opened");
}

uint64_t OgawaFile::top_object()
{
    constexpr uint64_t kRootGroup = 8, kTopObject = 2;
    return element(number_at(kRootGroup), kTopObject);
}

uint64_t OgawaFile::element(uint64_t group, uint64_t index)
{
    const uint64_t count = number_at(group);
    if (index >= count || index > UINT32_MAX)
        throw Error(format("damaged: a group has element {}, but there are only {}", index, count));
    return number_at(group + 8 + 8 * index);
}

std::string OgawaFile::text(uint64_t group)
{
    constexpr uint64_t kIsData = uint64_t(1) << 63, kKey = 16, kMost = 65536;
    const uint64_t data = element(group, 0);
    if (!(data & kIsData))
        throw Error("damaged: a text is not data");
    const uint64_t at = data & ~kIsData, size = at == 0 ? 0 : number_at(at);
    if (size <= kKey || size > kMost)
        return "";
    std::string text(size - kKey, '\0');
    read(at + 8 + kKey, text.data(), text.size());
    return text.substr(0, text.find('\0'));
}

void OgawaFile::read(uint64_t position, void* dst, uint64_t size)
{
    constexpr uint64_t kFarthest = uint64_t(1) << 62;
    if (position > kFarthest || !m_file.seekg(std::streamoff(position))
        || !m_file.read(static_cast<char*>(dst), std::streamsize(size)))
        throw Error(format("ends early, or is damaged: there is nothing at byte {}", position));
}

uint64_t OgawaFile::number_at(uint64_t position)
{
    uint64_t number = 0;
    read(position, &number, sizeof(number));
    return number;
}

} // namespace vmlight::alembic
