// SPDX-License-Identifier: Apache-2.0
// The journal of vmcost: rows that were measured before.
#include "cases.h"
#include "temporary_folder.h"

#include <vmcost/journal.h>
#include <vmcost/models.h>

#include <gtest/gtest.h>

using namespace vmlight;
using namespace vmlight::cost;

namespace {

class CostJournal : public testing::Test
{
protected:
    CostJournal()
    {
        row.environment = "sky";
        row.setting = default_setting("paper");
        row.errors.rmse.value = 0.1;
    }

    const TemporaryFolder folder;
    const std::string path = folder / "journal.jsonl";
    std::string error;
    Row row;
};

} // namespace

TEST_F(CostJournal, ATornLineIsPassedOverAndTheNextOneStandsOnItsOwn)
{
    Journal writer;
    ASSERT_TRUE(writer.open(path, error) && writer.add("a", row, error)) << error;
    folder.write("journal.jsonl", folder.bytes("journal.jsonl") + "{\"key\": \"b\", \"environ");
    Journal torn;
    ASSERT_TRUE(torn.open(path, error)) << error;
    ASSERT_NE(torn.find("a"), nullptr);
    EXPECT_EQ(torn.find("a")->errors.rmse.value, 0.1);
    EXPECT_EQ(torn.find("b"), nullptr);
    EXPECT_EQ(torn.damaged(), 1);
    ASSERT_TRUE(torn.add("c", row, error)) << error;
    Journal whole;
    ASSERT_TRUE(whole.open(path, error)) << error;
    EXPECT_NE(whole.find("a"), nullptr);
    EXPECT_NE(whole.find("c"), nullptr);
    EXPECT_EQ(whole.damaged(), 0) << "what was torn is said once";
    EXPECT_FALSE(Journal().open(folder / "", error)) << "a folder";
    EXPECT_FALSE(Journal().add("d", row, error)) << "no file was opened";
}

TEST_F(CostJournal, ARowWithAnyWrongBitIsMeasuredAgain)
{
    Journal writer;
    ASSERT_TRUE(writer.open(path, error) && writer.add("a", row, error) && writer.add("b", row, error)) << error;
    const std::string good = folder.bytes("journal.jsonl");
    const size_t line = good.find('\n') + 1;
    const size_t stride = line / size_t(cases(int(line), 64)); // of all bytes
    for (size_t byte = 0; byte + 1 < line; byte += stride)
        for (const int bit : { 0, 2, 6 }) {
            std::string damaged = good;
            damaged[byte] = char(damaged[byte] ^ (1 << bit));
            folder.write("journal.jsonl", damaged);
            Journal journal;
            ASSERT_TRUE(journal.open(path, error)) << error;
            EXPECT_GE(journal.damaged(), 1) << byte;
            EXPECT_EQ(journal.find("a"), nullptr) << byte;
            EXPECT_NE(journal.find("b"), nullptr) << byte;
            EXPECT_EQ(folder.bytes("journal.jsonl"), good.substr(line)) << "what is damaged is dropped";
        }
}
