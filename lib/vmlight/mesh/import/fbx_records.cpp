// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/fbx_records.h>

#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cstdint>

namespace vmlight {
namespace {

constexpr size_t kMaxDepth = 1000; // of brackets; an FBX has about six
constexpr size_t kProperties = 4; // the first ones of a record: no more are needed

std::string too_deep()
{
    return format("brackets are nested more than {} deep", kMaxDepth);
}

// Words and strings, tokenized as assimp does: a word before a colon names a record, others are its properties.
std::string read_text(const std::string& text, const FbxVisitor& visit)
{
    const size_t end = std::min(text.size(), text.find('\0'));
    size_t depth = 0, word = end;
    std::string list, record;
    std::vector<std::string> properties;
    const auto add_property = [&](size_t from, size_t to) {
        if (depth == 1 && properties.size() < kProperties)
            properties.push_back(text.substr(from, to - from));
    };
    const auto end_word = [&](size_t at) {
        if (word < at)
            add_property(word, at);
        word = end;
    };
    const auto end_record = [&] {
        if (depth == 1)
            visit(list, record, properties);
        properties.clear();
    };
    for (size_t at = 0; at < end; ++at) {
        const char c = text[at];
        if (c == ':') {
            end_record();
            if (depth <= 1)
                (depth == 0 ? list : record) = text.substr(std::min(word, at), at - std::min(word, at));
            word = end;
        } else if (c == '"') {
            const size_t close = std::min(end, text.find('"', at + 1));
            add_property(at + 1, close);
            at = close;
        } else if (c == '{' || c == '}') {
            end_word(at);
            end_record();
            if (c == '}' && depth-- == 0)
                return ""; // assimp reads no further
            if (c == '{' && ++depth > kMaxDepth)
                return too_deep();
            record.clear();
        } else if (c == ';') {
            end_word(at);
            at = std::min(end, text.find_first_of("\r\n\f", at));
        } else if (c == ',' || c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f') {
            end_word(at);
        } else {
            word = std::min(word, at);
        }
    }
    return "";
}

// Nested records, each with the offset of its end.
class BinaryReader
{
public:
    explicit BinaryReader(const std::string& bytes)
        : m_bytes(bytes)
    {
    }

    std::string read(const FbxVisitor& visit)
    {
        constexpr size_t kVersion = 23, kFirst = 27;
        const size_t whole = m_bytes.size() + 1; // assimp appends a zero
        m_at = kVersion;
        const size_t word = number(4, whole) < 7500 ? 4 : 8, last = 3 * word + 1; // a record of zeros ends a list
        std::vector<size_t> ends; // of the open lists, without their last record
        std::string list;
        for (size_t start = m_at = kFirst;; start = m_at) {
            if (!ends.empty() && m_at == ends.back()) {
                m_at += last;
                ends.pop_back();
                continue;
            }
            if (m_at == whole)
                return "";
            const size_t limit = ends.empty() ? whole : ends.back();
            const uint64_t end = number(word, limit);
            if (m_good && end == 0 && ends.empty())
                return "";
            if (m_good && end == 0)
                continue; // assimp reads zeros within a list one word at a time
            number(word, limit); // count of properties
            const uint64_t length = number(word, limit);
            const std::string record = text(number(1, limit), limit);
            const size_t first = m_at;
            m_good = m_good && end <= limit && first <= end && length <= end - first
                && (length == end - first || end - first - length >= last);
            if (!m_good)
                return format("record at byte {} extends past the record that contains it", start);
            if (ends.size() == 1)
                visit(list, record, properties(first + length));
            m_at = first + length;
            if (m_at == end)
                continue;
            if (ends.empty())
                list = record;
            ends.push_back(end - last);
            if (ends.size() > kMaxDepth)
                return too_deep();
        }
    }

private:
    // The first few, up to one that is neither a 64-bit integer nor a string: Models and connections have no others.
    std::vector<std::string> properties(size_t end)
    {
        std::vector<std::string> result;
        while (result.size() < kProperties && m_at < end) {
            const char type = m_bytes[m_at++];
            if (type == 'L')
                result.push_back(std::to_string(number(8, end)));
            else if (type == 'S')
                result.push_back(text(number(4, end), end));
            else
                break;
        }
        m_good = true; // whether they fit is left to assimp
        return result;
    }

    uint64_t number(size_t size, size_t limit)
    {
        uint64_t result = 0;
        m_good = m_good && m_at <= limit && size <= limit - m_at;
        for (size_t i = 0; m_good && i < size; ++i)
            result |= uint64_t(uint8_t(m_bytes[m_at++])) << (8 * i);
        return result;
    }

    std::string text(size_t size, size_t limit)
    {
        m_good = m_good && m_at <= limit && size <= limit - m_at;
        if (!m_good)
            return "";
        m_at += size;
        return std::string(m_bytes.data() + m_at - size, size); // may include the zero past the end
    }

    const std::string& m_bytes;
    size_t m_at = 0;
    bool m_good = true;
};

} // namespace

std::string read_fbx_records(const std::string& bytes, const FbxVisitor& visit)
{
    return OIIO::Strutil::starts_with(bytes, kFbxMagic) ? BinaryReader(bytes).read(visit) : read_text(bytes, visit);
}

} // namespace vmlight
