// SPDX-License-Identifier: Apache-2.0
/// The text of OBJ and MTL files: lines, statements and words.
#pragma once

#include <vmlight/mesh/import/text_number.h>

#include <OpenImageIO/string_view.h>

#include <cstddef>
#include <string>
#include <vector>

namespace vmlight::obj {

/// One line, or several that are joined by backslashes at their ends.
struct Statement
{
    OIIO::string_view keyword;
    OIIO::string_view arguments; ///< without blanks around them
    size_t line; ///< of its start, from 1
};

/// Drop the word that `text` starts with, and blanks before it. Returns it, "" at the end.
OIIO::string_view next_word(OIIO::string_view& text);

/// Arguments that are numbers or words, without the comment behind them.
OIIO::string_view without_comment(OIIO::string_view arguments);

/// Arguments that are a name or a path, which may have blanks. Only a number sign between blanks starts a comment:
/// 3ds Max calls materials "Material #25".
std::string name_in(OIIO::string_view arguments);

/// The statement as an error quotes it.
std::string quoted(const Statement& statement);

/// Splits a text into statements. Lines end in LF, CR or both. A byte order mark, empty lines and comments are skipped.
class Statements
{
public:
    explicit Statements(const std::string& text);
    /// False at the end. What `statement` points to is valid until the next call.
    bool next(Statement& statement);

private:
    OIIO::string_view next_line();

    OIIO::string_view m_rest;
    std::string m_joined;
    size_t m_line = 0;
};

} // namespace vmlight::obj
