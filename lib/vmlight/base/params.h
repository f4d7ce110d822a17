// SPDX-License-Identifier: Apache-2.0
/// Parameters, once. Each params struct lists its parameters in one visit(); flags, recipe keys, ?query keys and
/// metadata all follow from it, with one spelling (a flag writes '-' for '_') and one strict parser.
/// Params know nothing of files, images or flags.
#pragma once

#include <vmlight/base/export.h>

#include <OpenImageIO/imageio.h>

#include <string>
#include <vector>

namespace vmlight {

/// Numbers from `min` to `max`, both allowed. If `word` is given, that word stands for `word_value`.
struct Range
{
    double min, max;
    const char* word = nullptr;
    double word_value = 0;
};
/// Width and height of an image, in pixels.
struct Size
{
    int width, height;
};
/// "256x128", or one number: the width, the height following by `height_share`. From 1x1 to `max` x `max`.
struct SizeRange
{
    int max;
    double height_share;
};
/// One of some words.
struct Choices
{
    std::vector<const char*> words;
};
/// Some of these words, each at most once, separated by commas. Their order says nothing: they are kept in that of
/// `words`, so that one choice has one text.
struct Words
{
    std::vector<const char*> words;
};
/// Any text.
struct Text
{ };
/// The name of a file or image; "" is none.
struct Path
{ };
/// Names of files or images. As a text one a line, so that every name that holds no line break survives; a flag or
/// ?query key that comes more than once adds a line each time.
struct Paths
{ };
/// Either nothing or exactly `count` finite numbers, separated by commas or blanks.
struct Numbers
{
    size_t count;
};
/// A bool: a flag without a value; true, false, 1 or 0 elsewhere.
struct Flag
{ };

// Strict parsing: the whole text must be the value. On failure `dst` keeps its value and `error` says
// what is wrong, the value and what is allowed, without the parameter's name.
VMLIGHT_API bool parse_value(int& dst, OIIO::string_view text, const Range& allowed, std::string& error);
VMLIGHT_API bool parse_value(double& dst, OIIO::string_view text, const Range& allowed, std::string& error);
VMLIGHT_API bool parse_value(Size& dst, OIIO::string_view text, const SizeRange& allowed, std::string& error);
VMLIGHT_API bool parse_value(std::string& dst, OIIO::string_view text, const Choices& allowed, std::string& error);
VMLIGHT_API bool parse_value(std::vector<std::string>& dst, OIIO::string_view text, const Words& allowed,
                             std::string& error);
VMLIGHT_API bool parse_value(std::string& dst, OIIO::string_view text, const Text& allowed, std::string& error);
VMLIGHT_API bool parse_value(std::string& dst, OIIO::string_view text, const Path& allowed, std::string& error);
VMLIGHT_API bool parse_value(std::vector<std::string>& dst, OIIO::string_view text, const Paths& allowed,
                             std::string& error);
VMLIGHT_API bool parse_value(std::vector<double>& dst, OIIO::string_view text, const Numbers& allowed,
                             std::string& error);
VMLIGHT_API bool parse_value(bool& dst, OIIO::string_view text, const Flag& allowed, std::string& error);

// The text that parse_value() reads back to the same value.
VMLIGHT_API std::string value_text(int value, const Range& allowed);
VMLIGHT_API std::string value_text(double value, const Range& allowed);
VMLIGHT_API std::string value_text(const Size& value, const SizeRange& allowed);
VMLIGHT_API std::string value_text(const std::string& value, const Choices& allowed);
VMLIGHT_API std::string value_text(const std::vector<std::string>& value, const Words& allowed);
VMLIGHT_API std::string value_text(const std::string& value, const Text& allowed);
VMLIGHT_API std::string value_text(const std::string& value, const Path& allowed);
VMLIGHT_API std::string value_text(const std::vector<std::string>& value, const Paths& allowed);
VMLIGHT_API std::string value_text(const std::vector<double>& value, const Numbers& allowed);
VMLIGHT_API std::string value_text(bool value, const Flag& allowed);

// What is allowed, in a few characters, for a help text: "1..65536", "cosine|uniform", "x,y,z".
VMLIGHT_API std::string allowed_text(const Range& allowed);
VMLIGHT_API std::string allowed_text(const SizeRange& allowed);
VMLIGHT_API std::string allowed_text(const Choices& allowed);
VMLIGHT_API std::string allowed_text(const Words& allowed);
VMLIGHT_API std::string allowed_text(const Text& allowed);
VMLIGHT_API std::string allowed_text(const Path& allowed);
VMLIGHT_API std::string allowed_text(const Paths& allowed);
VMLIGHT_API std::string allowed_text(const Numbers& allowed);
VMLIGHT_API std::string allowed_text(const Flag& allowed);

/// The name among `names` that differs from `name` by the fewest edits, or "" if none is near.
VMLIGHT_API std::string nearest_name(OIIO::string_view name, const std::vector<std::string>& names);

// A struct's visit() may make up the names it hands out: what needs a name after its call must copy it.

/// Names of all parameters of `params`, in order.
template <class Params> std::vector<std::string> param_names(Params params)
{
    std::vector<std::string> names;
    params.visit([&](const char* name, auto&, const auto&, const char*) { names.push_back(name); });
    return names;
}

/// Set one parameter from text. False, with the reason in `error`, if there is no such parameter (the nearest name is
/// told) or the text is not a value that it takes.
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

/// False, with the reason in `error`, if a value that was set in code is not allowed.
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

/// Add every parameter to `spec` as `vmlight:<parameter>`: as text that set_param() reads back.
template <class Params> void append_params(OIIO::ImageSpec& spec, Params params)
{
    params.visit([&](const char* field, auto& value, const auto& allowed, const char*) {
        spec.attribute(std::string("vmlight:") + field, value_text(value, allowed));
    });
}

} // namespace vmlight
