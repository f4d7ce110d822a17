// SPDX-License-Identifier: Apache-2.0
#include "journal.h"

#include "row_json.h"

#include <vmlight/base/format.h>
#include <vmlight/base/interrupt.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/hash.h>
#include <OpenImageIO/strutil.h>

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace vmlight::cost {

bool Journal::open(const std::string& path, std::string& error)
{
    m_path = path;
    std::string text;
    if (!OIIO::Filesystem::exists(path))
        return true;
    if (!OIIO::Filesystem::is_regular(path) || !OIIO::Filesystem::read_text_file(path, text)) {
        error = format("\"{}\": cannot be read", path);
        return false;
    }
    m_incomplete_line = !text.empty() && text.back() != '\n';
    for (const std::string& line : OIIO::Strutil::splits(text, "\n")) {
        const auto json = nlohmann::json::parse(line, nullptr, false);
        Row row;
        if (json.is_object() && json.contains("key") && json["key"].is_string() && row_from_json(row, json))
            m_rows[json["key"].get<std::string>()] = row;
    }
    return true;
}

const Row* Journal::find(const std::string& key) const
{
    const auto found = m_rows.find(key);
    return found == m_rows.end() ? nullptr : &found->second;
}

bool Journal::add(const std::string& key, const Row& row, std::string& error)
{
    auto json = row_to_json(row);
    json["key"] = key;
    const std::string line = (m_incomplete_line ? "\n" : "")
        + json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    m_incomplete_line = false;
    m_rows[key] = row;
    const DeferInterrupts writing;
    const int file = ::open(m_path.c_str(), O_CREAT | O_APPEND | O_WRONLY, 0666);
    // A single write, so that a killed run leaves no partial line.
    const bool good = file >= 0 && ::write(file, line.data(), line.size()) == ssize_t(line.size());
    if (!good)
        error = format("\"{}\": {}", m_path, std::strerror(errno));
    if (file >= 0)
        ::close(file);
    return good;
}

std::string hash_key(const std::string& text)
{
    OIIO::SHA1 hash(text.data(), text.size());
    return hash.digest();
}

} // namespace vmlight::cost
