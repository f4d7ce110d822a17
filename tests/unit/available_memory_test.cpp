// SPDX-License-Identifier: Apache-2.0
/// What memory there is, as the system's files tell it.
#include "temporary_folder.h"

#include <vmlight/base/available_memory.h>
#include <vmlight/stage/forecast_costs.h>

#include <limits>

using namespace vmlight;

namespace {

constexpr int64_t kMebi = 1 << 20;

void write_system_file(const TemporaryFolder& root, const std::string& name, const std::string& text)
{
    std::filesystem::create_directories(std::filesystem::path(root / name).parent_path());
    root.write(name, text);
}

const std::string kMachine = "MemTotal: 8192 kB\nMemFree: 100 kB\nMemAvailable:    4096 kB\nSwapFree:  1024 kB\n";

} // namespace

TEST(MemoryNeed, IsUnlimitedWhereNothingTells)
{
    const TemporaryFolder root;
    EXPECT_EQ(available_memory(root / ""), std::numeric_limits<int64_t>::max());
}

TEST(MemoryNeed, IsWhatTheMachineHasFreeWithItsSwap)
{
    const TemporaryFolder root;
    write_system_file(root, "proc/meminfo", kMachine);
    EXPECT_EQ(available_memory(root / ""), 5 * kMebi);
}

TEST(MemoryNeed, IsWhatTheLeastOfTheGroupsAroundItLeaves)
{
    const TemporaryFolder root;
    write_system_file(root, "proc/meminfo", kMachine);
    write_system_file(root, "proc/self/cgroup", "0::/farm/job\n");
    write_system_file(root, "sys/fs/cgroup/farm/job/memory.max", "max\n");
    EXPECT_EQ(available_memory(root / ""), 5 * kMebi);
    write_system_file(root, "sys/fs/cgroup/farm/memory.max", "3145728\n");
    EXPECT_EQ(available_memory(root / ""), 4 * kMebi);
    write_system_file(root, "sys/fs/cgroup/farm/memory.current", "2097152\n");
    EXPECT_EQ(available_memory(root / ""), 2 * kMebi);
    write_system_file(root, "sys/fs/cgroup/farm/memory.stat", "anon 7\nfile_mapped 9\nfile 1048576\n");
    EXPECT_EQ(available_memory(root / ""), 3 * kMebi);
    write_system_file(root, "sys/fs/cgroup/farm/memory.stat", "anon 7\nfile_mapped 9\nfile 1048576\nshmem 524288\n");
    EXPECT_EQ(available_memory(root / ""), 5 * kMebi / 2) << "files of a tmpfs stay";
    write_system_file(root, "sys/fs/cgroup/farm/memory.swap.max", "0\n");
    EXPECT_EQ(available_memory(root / ""), 3 * kMebi / 2) << "the machine's swap is not for this group";
    write_system_file(root, "sys/fs/cgroup/farm/memory.swap.max", "max\n");
    write_system_file(root, "sys/fs/cgroup/farm/memory.current", "99999999\n");
    EXPECT_EQ(available_memory(root / ""), kMebi) << "more than the limit";
}

TEST(MemoryNeed, KnowsTheFirstVersionOfGroups)
{
    const TemporaryFolder root;
    write_system_file(root, "proc/meminfo", kMachine);
    write_system_file(root, "proc/self/cgroup", "5:cpu,cpuacct:/x\n4:memory:/job\n0::/\n");
    write_system_file(root, "sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    write_system_file(root, "sys/fs/cgroup/memory/job/memory.limit_in_bytes", "3145728\n");
    write_system_file(root, "sys/fs/cgroup/memory/job/memory.usage_in_bytes", "2097152\n");
    write_system_file(root, "sys/fs/cgroup/memory/job/memory.stat", "cache 1\ntotal_cache 1048576\n");
    EXPECT_EQ(available_memory(root / ""), 3 * kMebi);
}

TEST(MemoryNeed, RefusesWhatNoMachineHolds)
{
    EXPECT_EQ(memory_shortage(OIIO::ImageSpec(1024, 1024, 4)), "");
    EXPECT_EQ(memory_shortage(OIIO::ImageSpec()), "");
    const std::string fault = memory_shortage(OIIO::ImageSpec(1 << 30, 1 << 30, 16));
    EXPECT_EQ(fault.find("1073741824x1073741824 pixels of 16 channels need "), 0u) << fault;
}

TEST(ExpectedBytes, AreNoLessThanWhatTheInputsTook)
{
    constexpr size_t kBytes = size_t(1) << 28;
    const OIIO::ImageSpec small(4, 4, 4, OIIO::TypeFloat);
    const double before = vmlight::expected_bytes(double(small.image_bytes()));
    {
        const std::vector<char> input(kBytes, 1);
        EXPECT_EQ(input[kBytes / 2], 1);
    }
    EXPECT_GE(vmlight::expected_bytes(double(small.image_bytes())), double(kBytes));
    EXPECT_GE(vmlight::expected_bytes(double(small.image_bytes())), before);
}
