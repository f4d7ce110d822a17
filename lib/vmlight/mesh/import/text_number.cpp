// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/text_number.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace vmlight {
namespace {

bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

// The value of up to `most` digits, which are dropped from `word`, as are all digits that follow them.
uint64_t take_digits(OIIO::string_view& word, size_t most)
{
    uint64_t value = 0;
    for (; !word.empty() && is_digit(word[0]); word.remove_prefix(1))
        if (most > 0) {
            value = value * 10 + uint64_t(word[0] - '0');
            --most;
        }
    return value;
}

// See TextNumber::rounded: what is before the point and what is behind it are rounded on their own, then their sum.
float rounded_in_steps(OIIO::string_view word, double value)
{
    const bool is_negative = word[0] == '-';
    word.remove_prefix(is_negative || word[0] == '+' ? 1 : 0);
    const size_t digits = std::min(word.find_first_not_of("0123456789"), word.size());
    if (digits > 19) // more than 64 bits
        return nearest_float(value);
    float sum = float(take_digits(word, digits));
    if (!word.empty() && word[0] == '.') {
        word.remove_prefix(1);
        constexpr double kUnits[]
            = { 1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15 };
        const size_t count = std::min<size_t>(std::min(word.find_first_not_of("0123456789"), word.size()), 15);
        sum += float(double(take_digits(word, 15)) * kUnits[count]);
    }
    if (!word.empty()) { // an exponent
        word.remove_prefix(1);
        const bool is_small = word[0] == '-';
        word.remove_prefix(is_small || word[0] == '+' ? 1 : 0);
        const float exponent = float(take_digits(word, 9));
        sum *= std::pow(10.0f, is_small ? -exponent : exponent);
    }
    if (!std::isfinite(sum)) // 0e99 and .001e40 are no infinities
        return nearest_float(value);
    return is_negative ? -sum : sum;
}

// Of a word without a plus sign and with a point.
bool parse_plain(OIIO::string_view word, TextNumber& number)
{
    const char *begin = word.data(), *end = begin + word.size();
    const auto [rest, problem] = std::from_chars(begin, end, number.value);
    if (problem == std::errc::invalid_argument)
        return false;
    if (problem == std::errc::result_out_of_range)
        number.value = OIIO::Strutil::strtod(std::string(begin, rest).c_str());
    const OIIO::string_view tail(rest, size_t(end - rest));
    if (tail.size() > 3 && tail[0] == '#') { // 1.#IND, 1.#QNAN, 1.#SNAN, 1.#INF
        const bool is_infinite = OIIO::Strutil::istarts_with(tail, "#INF");
        number.value = is_infinite ? std::copysign(std::numeric_limits<double>::infinity(), number.value)
                                   : std::numeric_limits<double>::quiet_NaN();
    } else if (!tail.empty()) {
        return false;
    }
    const bool is_decimal = tail.empty() && std::isfinite(number.value) && problem == std::errc();
    number.rounded = is_decimal ? rounded_in_steps(word, number.value) : nearest_float(number.value);
    return true;
}

} // namespace

float nearest_float(double value)
{
    constexpr float kMost = std::numeric_limits<float>::max(), kInfinity = std::numeric_limits<float>::infinity();
    if (std::abs(value) > double(kMost)) // conversion of what no float holds is undefined
        return value > 0 ? kInfinity : -kInfinity;
    return float(value);
}

bool parse_number(OIIO::string_view word, TextNumber& number)
{
    if (word.size() > 1 && word[0] == '+' && word[1] != '-')
        word.remove_prefix(1);
    if (parse_plain(word, number))
        return true;
    const size_t comma = word.find(',');
    if (comma == OIIO::string_view::npos || word.find('.') != OIIO::string_view::npos)
        return false;
    std::string with_point = word;
    with_point[comma] = '.';
    return parse_plain(with_point, number);
}

} // namespace vmlight
