// SPDX-License-Identifier: Apache-2.0
/// Parameters, declared once: each params struct lists its parameters in one visit(). Flags, help, man pages, shell
/// completion, recipe keys, ?query keys and metadata all derive from it, with one spelling (flags use '-' for '_') and
/// one strict parser. Params know nothing of files, images or flags.
#pragma once

#include <vmlight/base/export.h>

#include <OpenImageIO/imageio.h>

#include <string>
#include <type_traits>
#include <vector>

namespace vmlight {

/// A number in [min, max]. `word`, if set, is a name for `word_value`, which is out of that range: only the word means
/// "none" or the like, so that no number next to others means the opposite of them.
struct Range
{
    double min, max;
    const char* word = nullptr;
    double word_value = 0;
};
/// Width and height of an image in pixels.
struct Size
{
    int width, height;
};
/// "256x128", or one number: the width, with the height following as width * height_share. From 1x1 to max x max.
struct SizeRange
{
    int max;
    double height_share;
};
/// A word that a parameter accepts, and a phrase for the help that explains it.
struct Choice
{
    const char *word, *meaning;
};
/// One of these words.
struct Choices
{
    std::vector<Choice> choices;
};
/// Any of these words, each at most once, separated by commas, in any order. They are stored in the order of `choices`,
/// so that equal sets have equal text.
struct ChoiceSet
{
    std::vector<Choice> choices;
};
/// Any text.
struct Text
{
    const char* placeholder = "TEXT"; ///< what help calls it
};
/// The name of a file or image; "" means none.
struct Path
{ };
/// Names of files or images. As text, one per line, so that names may contain anything but a line break. A flag or
/// ?query key that is repeated adds a name each time.
struct Paths
{ };
/// Names of things in a file. As text, and when repeated, as Paths.
struct Names
{ };
/// Whether a parameter takes one value per line.
template <class Allowed> constexpr bool kTakesLines = std::is_same_v<Allowed, Paths> || std::is_same_v<Allowed, Names>;
/// Exactly `count` finite numbers, separated by commas or spaces; or nothing.
struct Numbers
{
    size_t count;
};
/// A bool: a flag without a value; true, false, 1 or 0 elsewhere.
struct Flag
{ };

/// The help line of a parameter.
struct Help
{
    Help(const char* line, bool advanced = false)
        : text(line)
        , is_advanced(advanced)
    {
    }
    operator const char*() const { return text; }

    const char* text;
    /// Rarely needed: listed last in --help.
    bool is_advanced;
};
inline Help advanced(const char* text)
{
    return { text, true };
}

// Strict parsing: the whole text must be a valid value. On failure `dst` is unchanged and `error` says what is wrong,
// the value and what is allowed, without the parameter's name.
VMLIGHT_API bool parse_value(int& dst, OIIO::string_view text, const Range& allowed, std::string& error);
VMLIGHT_API bool parse_value(double& dst, OIIO::string_view text, const Range& allowed, std::string& error);
VMLIGHT_API bool parse_value(Size& dst, OIIO::string_view text, const SizeRange& allowed, std::string& error);
VMLIGHT_API bool parse_value(std::string& dst, OIIO::string_view text, const Choices& allowed, std::string& error);
VMLIGHT_API bool parse_value(std::vector<std::string>& dst, OIIO::string_view text, const ChoiceSet& allowed,
                             std::string& error);
VMLIGHT_API bool parse_value(std::string& dst, OIIO::string_view text, const Text& allowed, std::string& error);
VMLIGHT_API bool parse_value(std::string& dst, OIIO::string_view text, const Path& allowed, std::string& error);
VMLIGHT_API bool parse_value(std::vector<std::string>& dst, OIIO::string_view text, const Paths& allowed,
                             std::string& error);
VMLIGHT_API bool parse_value(std::vector<std::string>& dst, OIIO::string_view text, const Names& allowed,
                             std::string& error);
VMLIGHT_API bool parse_value(std::vector<double>& dst, OIIO::string_view text, const Numbers& allowed,
                             std::string& error);
VMLIGHT_API bool parse_value(bool& dst, OIIO::string_view text, const Flag& allowed, std::string& error);

// Text that parse_value() reads back to the same value.
VMLIGHT_API std::string value_text(int value, const Range& allowed);
VMLIGHT_API std::string value_text(double value, const Range& allowed);
VMLIGHT_API std::string value_text(const Size& value, const SizeRange& allowed);
VMLIGHT_API std::string value_text(const std::string& value, const Choices& allowed);
VMLIGHT_API std::string value_text(const std::vector<std::string>& value, const ChoiceSet& allowed);
VMLIGHT_API std::string value_text(const std::string& value, const Text& allowed);
VMLIGHT_API std::string value_text(const std::string& value, const Path& allowed);
VMLIGHT_API std::string value_text(const std::vector<std::string>& value, const Paths& allowed);
VMLIGHT_API std::string value_text(const std::vector<std::string>& value, const Names& allowed);
VMLIGHT_API std::string value_text(const std::vector<double>& value, const Numbers& allowed);
VMLIGHT_API std::string value_text(bool value, const Flag& allowed);

// The accepted values, in brief, for usage: "1..65536", "cosine|uniform", "3 numbers".
VMLIGHT_API std::string allowed_text(const Range& allowed);
VMLIGHT_API std::string allowed_text(const SizeRange& allowed);
VMLIGHT_API std::string allowed_text(const Choices& allowed);
VMLIGHT_API std::string allowed_text(const ChoiceSet& allowed);
VMLIGHT_API std::string allowed_text(const Text& allowed);
VMLIGHT_API std::string allowed_text(const Path& allowed);
VMLIGHT_API std::string allowed_text(const Paths& allowed);
VMLIGHT_API std::string allowed_text(const Names& allowed);
VMLIGHT_API std::string allowed_text(const Numbers& allowed);
VMLIGHT_API std::string allowed_text(const Flag& allowed);

/// The words that a parameter accepts; none unless it takes words.
inline std::vector<Choice> choices_of(const Choices& allowed)
{
    return allowed.choices;
}
inline std::vector<Choice> choices_of(const ChoiceSet& allowed)
{
    return allowed.choices;
}
template <class Allowed> std::vector<Choice> choices_of(const Allowed&)
{
    return {};
}

/// The name among `names` with the least edit distance to `name`, or "" if none is close: for "did you mean".
VMLIGHT_API std::string nearest_name(OIIO::string_view name, const std::vector<std::string>& names);

// visit() calls field(name, value, allowed, help) for each parameter. Names may be temporary: copy them to keep them.

/// Names of all parameters of `params`, in order.
template <class Params> std::vector<std::string> param_names(Params params)
{
    std::vector<std::string> names;
    params.visit([&](const char* name, auto&, const auto&, const char*) { names.push_back(name); });
    return names;
}

/// Set one parameter from text. Returns false, with the reason in `error`, if there is no such parameter (the error
/// suggests the closest name) or it does not accept the text.
template <class Params>
bool set_param(Params& params, OIIO::string_view name, OIIO::string_view text, std::string& error)
{
    bool found = false, good = false;
    params.visit([&](const char* field, auto& value, const auto& allowed, const char*) {
        if (name != field)
            return;
        found = true;
        std::string reason;
        good = parse_value(value, text, allowed, reason);
        if (!good)
            error = std::string(field) + ": " + reason;
    });
    if (!found) {
        const std::string near = nearest_name(name, param_names(params));
        error = "unknown parameter \"" + std::string(name) + "\"";
        if (!near.empty())
            error += "; did you mean \"" + near + "\"?";
    }
    return found && good;
}

/// Validate parameters that were set in code. Returns false, with the reason in `error`, if one is not allowed.
template <class Params> bool check_params(Params params, std::string& error)
{
    bool good = true;
    params.visit([&](const char* field, auto& value, const auto& allowed, const char*) {
        if (!good)
            return;
        auto copy = value;
        std::string reason;
        good = parse_value(copy, value_text(value, allowed), allowed, reason);
        if (!good)
            error = std::string(field) + ": " + reason;
    });
    return good;
}

/// The metadata of a parameter: `vmlight:` and its name.
VMLIGHT_API std::string metadata_name(const char* parameter);

/// Add every parameter to `spec` as `vmlight:<parameter>`, as text that set_param() reads back.
template <class Params> void append_params(OIIO::ImageSpec& spec, Params params)
{
    params.visit([&](const char* field, auto& value, const auto& allowed, const char*) {
        spec.attribute(metadata_name(field), value_text(value, allowed));
    });
}

} // namespace vmlight
