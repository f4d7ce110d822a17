// SPDX-License-Identifier: Apache-2.0
#include "journal.h"

#include "row_json.h"

#include <vmlight/base/format.h>
#include <vmlight/base/interrupt.h>
#include <vmlight/base/output_file.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/hash.h>
#include <OpenImageIO/strutil.h>

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace vmlight::cost {

namespace {

constexpr const char* kChecksum = ",\"checksum\":\"";

// A line without its last brace, and behind it the checksum of that as its last member.
std::string with_checksum(const std::string& line)
{
    return line + kChecksum + hash_key(line) + "\"}";
}

} // namespace

bool Journal::open(const std::string& path, std::string& error)
{
    m_path = path;
    std::string text, good;
    if (!OIIO::Filesystem::exists(path))
        return true;
    if (!OIIO::Filesystem::is_regular(path) || !OIIO::Filesystem::read_text_file(path, text)) {
        error = format("\"{}\": cannot be read", path);
        return false;
    }
    for (const std::string& line : OIIO::Strutil::splits(text, "\n")) {
        if (line.empty())
            continue;
        const auto json = line == with_checksum(line.substr(0, line.rfind(kChecksum)))
            ? nlohmann::json::parse(line, nullptr, false)
            : nlohmann::json();
        Row row;
        if (json.is_object() && json.contains("key") && json["key"].is_string() && row_from_json(row, json)) {
            m_rows[json["key"].get<std::string>()] = row;
            good += line + "\n";
        } else {
            ++m_damaged;
        }
    }
    // So that each is reported once, and the next row has a line of its own.
    return good == text || write_file(path, good, error);
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
    std::string line = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    line.pop_back();
    line = with_checksum(line) + "\n";
    m_rows[key] = row;
    const DeferInterrupts writing;
    const int file = ::open(m_path.c_str(), O_CREAT | O_APPEND | O_WRONLY, 0666);
    // A single write, so that a killed run leaves no partial line.
    const ssize_t written = file >= 0 ? ::write(file, line.data(), line.size()) : -1;
    if (written < 0)
        error = format("\"{}\": {}", m_path, std::strerror(errno));
    else if (written < ssize_t(line.size()))
        error = format("\"{}\": only {} of {} bytes could be written", m_path, written, line.size());
    if (file >= 0)
        ::close(file);
    return written == ssize_t(line.size());
}

std::string hash_key(const std::string& text)
{
    OIIO::SHA1 hash(text.data(), text.size());
    return hash.digest();
}

} // namespace vmlight::cost
