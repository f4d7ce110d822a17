// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

using namespace vmlight;

TEST(Format, KeepsEachKindOfValue)
{
    EXPECT_EQ(format("no values, {{}}"), "no values, {}");
    EXPECT_EQ(format("{} {} {}", true, 'x', "text"), "true x text");
    EXPECT_EQ(format("{}|{}", std::string("a string"), OIIO::string_view("a view")), "a string|a view");
    EXPECT_EQ(format("{} {}", std::numeric_limits<int64_t>::min(), std::numeric_limits<uint64_t>::max()),
              "-9223372036854775808 18446744073709551615");
    EXPECT_EQ(format("{} {}", static_cast<unsigned char>(200), static_cast<short>(-3)), "200 -3");
    // The shortest text that is read back as the same float: a double would show what .1f really is.
    EXPECT_EQ(format("{} {}", 0.1f, 0.1), "0.1 0.1");
    EXPECT_EQ(format("{}", double(0.1f)), "0.10000000149011612");
}

TEST(Format, KnowsTheSyntaxOfFmt)
{
    EXPECT_EQ(format("{0}-{1}-{0}", 1, 2), "1-2-1");
    EXPECT_EQ(format("{:04}|{:>5}|{:.2f}|{:.3g}|{:016x}|{:02x}", 42, "ab", 1.006, 12345.0, 0xabcu, 10), //
              "0042|   ab|1.01|1.23e+04|0000000000000abc|0a");
    EXPECT_EQ(format("{:.{}f} {:0{}}", 2.0, 3, 7, 4), "2.000 0007");
}
