// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/flag_table.h>

#include <nlohmann/json.hpp>

#include <deque>
#include <vector>

namespace vmlight {
namespace {

using Json = nlohmann::ordered_json;
using Option = CommandLine::Option;

// Words as constants: those of a process, which has one command line, are kept to its end.
const char* kept(const Json& text)
{
    static auto& texts = *new std::deque<std::string>;
    return texts.emplace_back(text.get<std::string>()).c_str();
}

Json range_json(const char* kind, const Range& range)
{
    Json json { { "kind", kind }, { "min", range.min }, { "max", range.max } };
    if (range.word)
        json["word"] = range.word;
    return json;
}

// What the word stands for is left out: it need not be a number that JSON has.
Range range_of(const Json& json)
{
    return { json.at("min"), json.at("max"), json.contains("word") ? kept(json["word"]) : nullptr };
}

// One entry for each kind of value, in the order of AllowedValue, which has those of words elsewhere.
struct ValueJson
{
    Json operator()(const std::monostate&) const { return nullptr; }
    Json operator()(const Range& range) const { return range_json("number", range); }
    Json operator()(const WholeNumber& number) const { return range_json("whole_number", number.range); }
    Json operator()(const SizeRange& size) const
    {
        return { { "kind", "size" }, { "max", size.max }, { "height_share", size.height_share } };
    }
    Json operator()(const Choices&) const { return { { "kind", "choice" } }; }
    Json operator()(const ChoiceSet&) const { return { { "kind", "choices" } }; }
    Json operator()(const Numbers& numbers) const { return { { "kind", "numbers" }, { "count", numbers.count } }; }
    Json operator()(const Paths&) const { return { { "kind", "names" } }; }
    Json operator()(const Text&) const { return { { "kind", "text" } }; }
    Json operator()(const Flag&) const { return { { "kind", "flag" } }; }
};

AllowedValue value_of(const Json& json, const std::vector<Choice>& choices)
{
    const std::string kind = json.is_null() ? "" : json.at("kind").get<std::string>();
    if (kind == "number")
        return range_of(json);
    if (kind == "whole_number")
        return WholeNumber { range_of(json) };
    if (kind == "size")
        return SizeRange { json.at("max"), json.at("height_share") };
    if (kind == "choice")
        return Choices { choices };
    if (kind == "choices")
        return ChoiceSet { choices };
    if (kind == "numbers")
        return Numbers { json.at("count") };
    if (kind == "names")
        return Paths {};
    if (kind == "text")
        return Text {};
    if (kind == "flag")
        return Flag {};
    return {};
}

Json option_json(const Option& option)
{
    Json json { { "heading", option.heading },      { "name", option.name },
                { "metavar", option.metavar },      { "help", option.help },
                { "advanced", option.is_advanced }, { "repeatable", option.is_repeatable } };
    json["value"] = std::visit(ValueJson {}, option.allowed);
    json["choices"] = Json::array();
    for (const Choice& choice : option.choices)
        json["choices"].push_back({ { "word", choice.word }, { "meaning", choice.meaning } });
    return json;
}

Option option_of(const Json& json)
{
    Option option;
    option.heading = json.at("heading");
    option.name = json.at("name");
    option.metavar = json.at("metavar");
    option.help = json.at("help");
    option.is_advanced = json.at("advanced");
    option.is_repeatable = json.at("repeatable");
    for (const Json& choice : json.at("choices"))
        option.choices.push_back({ kept(choice.at("word")), kept(choice.at("meaning")) });
    option.allowed = value_of(json.at("value"), option.choices);
    return option;
}

} // namespace

std::string flag_table(const CommandLine& line)
{
    Json json { { "name", line.name },
                { "purpose", line.purpose },
                { "operands", line.operand_names },
                { "output", line.output_metavar },
                { "needs_output", line.needs_output },
                { "stage", line.stage },
                { "examples", line.example } };
    json["form"] = { { "name", line.form.name }, { "operand", line.form.operand }, { "reason", line.form.reason } };
    json["flags"] = Json::array();
    for (const Option& option : line.options)
        json["flags"].push_back(option_json(option));
    return json.dump(1) + "\n";
}

CommandLine read_flag_table(const std::string& table)
{
    const Json json = Json::parse(table);
    CommandLine line;
    line.name = json.at("name");
    line.purpose = json.at("purpose");
    line.operand_names = json.at("operands").get<std::vector<std::string>>();
    line.output_metavar = json.at("output");
    line.needs_output = json.at("needs_output");
    line.stage = json.at("stage");
    line.example = json.at("examples");
    const Json& form = json.at("form");
    line.form = { form.at("name"), form.at("operand"), form.at("reason") };
    for (const Json& option : json.at("flags"))
        line.options.push_back(option_of(option));
    return line;
}

} // namespace vmlight
