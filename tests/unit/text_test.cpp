// SPDX-License-Identifier: Apache-2.0
/// The text functions of command lines do as those of OpenImageIO, which are loaded later.
#include <vmlight/base/text.h>

#include <OpenImageIO/strutil.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <clocale>

using namespace vmlight;
namespace oiio = OIIO::Strutil;

namespace {

const std::vector<std::string> kTexts {
    "",       " ",    "a",       " a",     "a ",
    "\t a\n", "a,b",  ",",       "a,,b",   ",a,",
    "aa",     "aaa",  "abab",    "A z Ä",  "--max-distance",
    "a_b_c",  "\\:[", "samples", "sample", "smaples",
    "it's",   "1e3",  "lobe",    "ao",     "a b  c\td",
    "ende",   "e",
};

} // namespace

TEST(Text, IsThatOfOpenImageIO)
{
    for (const std::string& text : kTexts) {
        EXPECT_EQ(std::string(stripped(text)), std::string(oiio::strip(text))) << text;
        EXPECT_EQ(in_capitals(text), oiio::upper(text)) << text;
        EXPECT_EQ(in_small_letters(text), oiio::lower(text)) << text;
        EXPECT_EQ(split_words(text), oiio::splits(oiio::strip(text))) << text;
        if (!text.empty()) {
            EXPECT_EQ(split(text, ','), oiio::splits(text, ",")) << text;
        }
        for (const std::string& other : kTexts) {
            EXPECT_EQ(starts_with(text, other), oiio::starts_with(text, other)) << text << "|" << other;
            EXPECT_EQ(ends_with(text, other), oiio::ends_with(text, other)) << text << "|" << other;
            // Of words far from each other OpenImageIO's is too small by one, at times.
            if (std::min(text.size(), other.size()) > 2 && oiio::edit_distance(text, other) < 4) {
                EXPECT_EQ(edit_distance(text, other), oiio::edit_distance(text, other)) << text << "|" << other;
            }
            if (!other.empty()) {
                EXPECT_EQ(replaced(text, other, "<a>"), oiio::replace(text, other, "<a>", true))
                    << text << "|" << other;
            }
        }
    }
}

// By hand: the fewest letters to put in, take out or change.
TEST(Text, EditDistance)
{
    EXPECT_EQ(edit_distance("", "abc"), 3u);
    EXPECT_EQ(edit_distance("samples", "samples"), 0u);
    EXPECT_EQ(edit_distance("smaples", "samples"), 2u);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
    EXPECT_EQ(edit_distance(" a", "--max-distance"), 13u) << "OpenImageIO 2.4 says 12";
}

TEST(Text, NumbersAreThoseOfOpenImageIOInAnyLocale)
{
    const std::string before = std::setlocale(LC_NUMERIC, nullptr);
    for (const char* locale : { "C", "de_DE.UTF-8" }) {
        std::setlocale(LC_NUMERIC, locale); // where it is not installed, the same again
        for (const char* text : { "0", "-0", "1.5", "1,5", "+2", " 3", ".5", "1e-400", "1e400", "nan", "inf", "x", "",
                                  "7 apples", "0x10", "123456789012345678901234567890" }) {
            char *end = nullptr, *expected_end = nullptr;
            const double value = number_at(text, &end), expected = oiio::strtod(text, &expected_end);
            EXPECT_TRUE(value == expected || (value != value && expected != expected)) << text;
            EXPECT_EQ(end, expected_end) << text;
        }
    }
    std::setlocale(LC_NUMERIC, before.c_str());
}
