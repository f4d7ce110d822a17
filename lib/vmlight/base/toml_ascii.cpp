// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/toml_text.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/base/utf8.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>

namespace vmlight {
namespace {

using OIIO::string_view;

constexpr size_t kMostDots = 100;

// Append `line` to `dst`, and return "" or what is wrong with it.
std::string append_ascii(std::string& dst, string_view line)
{
    enum
    {
        Plain,
        Basic,
        Literal,
        Comment
    } where
        = Plain;
    size_t dots = 0, count = 0;
    for (size_t i = 0; i < line.size(); i += count) {
        uint32_t code = 0;
        const char c = line[i];
        count = decode_utf8(line.substr(i), code);
        if (count == 0)
            return "not TOML: its bytes are not UTF-8";
        if ((code < 0x20 && c != '\t') || code == 0x7f)
            return format("not TOML: a control character ({})", code);
        if (count > 1) {
            if (where == Plain)
                return "not TOML: a character outside quotes that is not ASCII";
            dst += where == Comment ? "?" : format("\\U{:08x}", code);
        } else if (where == Plain && (c == '"' || c == '\'')) {
            if (line.substr(i, 3) == std::string(3, c))
                return "three quotes in a row: recipe strings are single-line";
            where = c == '"' ? Basic : Literal;
            dst += '"';
        } else if (where == Plain) {
            where = c == '#' ? Comment : Plain;
            dots += c == '.';
            dst += c;
            if (dots > kMostDots)
                return format("more than {} dots outside quotes", kMostDots);
        } else if (where == Literal) {
            where = c == '\'' ? Plain : Literal;
            dst += c == '\'' ? "\"" : c == '"' || c == '\\' ? std::string { '\\', c } : std::string(1, c);
        } else {
            const bool escapes
                = where == Basic && c == '\\' && i + 1 < line.size() && (line[i + 1] == '"' || line[i + 1] == '\\');
            where = where == Basic && c == '"' ? Plain : where;
            count = escapes ? 2 : 1;
            dst.append(line.data() + i, count);
        }
    }
    return "";
}

} // namespace

std::string at_line(const std::string& path, uint64_t line)
{
    return line ? format("\"{}\" line {}", path, line) : format("\"{}\"", path);
}

bool to_ascii(std::string& dst, string_view text, const std::string& path, std::string& error)
{
    if (OIIO::Strutil::starts_with(text, "\xEF\xBB\xBF")) // an editor's mark of UTF-8
        text.remove_prefix(3);
    for (uint64_t number = 1; !text.empty(); ++number) {
        const size_t end = std::min(text.find('\n'), text.size());
        string_view line = text.substr(0, end);
        if (end < text.size() && !line.empty() && line.back() == '\r')
            line.remove_suffix(1);
        const std::string fault = append_ascii(dst, line);
        if (!fault.empty()) {
            error = at_line(path, number) + ": " + fault;
            return false;
        }
        dst += '\n';
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return true;
}

bool parse_toml(toml::table& dst, OIIO::string_view text, const std::string& path, std::string& error)
{
    std::string ascii;
    if (!to_ascii(ascii, text, path, error))
        return false;
    toml::parse_result result = toml::parse(ascii);
    if (!result) {
        const toml::parse_error& fault = result.error();
        error = at_line(path, fault.source().begin.line)
            + ": not TOML: " + shortened_line(std::string(fault.description()));
        if (error.find("could not determine value type") != std::string::npos)
            error += "; strings need quotes";
        return false;
    }
    dst = std::move(result).table();
    return true;
}

} // namespace vmlight
