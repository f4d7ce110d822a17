// SPDX-License-Identifier: Apache-2.0
#include "arguments.h"

#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>

namespace vmlight::python {
namespace {

std::string words(const std::vector<Choice>& choices)
{
    std::vector<std::string> quoted;
    for (const Choice& choice : choices)
        quoted.push_back(literal(choice.word));
    return OIIO::Strutil::join(quoted, ", ");
}

Argument describe_number(const char* type, const Range& allowed, const std::string& value)
{
    if (!allowed.word)
        return { "", type, value, allowed_text(allowed), "" };
    const std::string word = literal(allowed.word);
    return { "", format("{} | Literal[{}]", type, word), value == allowed.word ? word : value,
             format("{} or {}", allowed_text(Range { allowed.min, allowed.max }), word), "" };
}

} // namespace

std::string literal(const std::string& text)
{
    return py::cast<std::string>(py::repr(py::str(text)));
}

std::string meanings(const std::vector<Choice>& choices)
{
    std::string text;
    for (const Choice& choice : choices)
        text += format("\n  {}: {}", literal(choice.word), choice.meaning);
    return text;
}

Argument describe(const Range& allowed, int value)
{
    return describe_number("int", allowed, value_text(value, allowed));
}

Argument describe(const Range& allowed, double value)
{
    return describe_number("float", allowed, value_text(value, allowed));
}

Argument describe(const SizeRange& allowed, Size value)
{
    return { "", "int | tuple[int, int]",
             allowed.height_share == 1 && value.width == value.height ? std::to_string(value.width)
                                                                      : format("({}, {})", value.width, value.height),
             format("a width{} or (width, height), each side up to {}",
                    allowed.height_share == 1 ? ", for a square," : "", allowed.max),
             "" };
}

Argument describe(const Choices& allowed, const std::string& value)
{
    return { "", format("Literal[{}]", words(allowed.choices)), literal(value), "", "" };
}

Argument describe(const ChoiceSet& allowed, const std::vector<std::string>& value)
{
    std::string all;
    for (const std::string& word : value)
        all += literal(word) + ", ";
    return { "", format("Sequence[Literal[{}]]", words(allowed.choices)), "(" + all + ")", "", "" };
}

Argument describe(const Text&, const std::string& value)
{
    return { "", "str", literal(value), "", "" };
}

Argument describe(const Path&, const std::string& value)
{
    return { "", "StrPath", literal(value), "", "" };
}

Argument describe(const Paths&, const std::vector<std::string>&)
{
    return { "", "StrPath | Sequence[StrPath]", "()", "", "" };
}

Argument describe(const Names&, const std::vector<std::string>&)
{
    return { "", "str | Sequence[str]", "()", "", "" };
}

Argument describe(const Numbers& allowed, const std::vector<double>&)
{
    return { "", "Floats", "()", format("{} floats", allowed.count), "" };
}

Argument describe(const Flag&, bool value)
{
    return { "", "bool", value ? "True" : "False", "", "" };
}

} // namespace vmlight::python
