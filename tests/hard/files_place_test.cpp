// SPDX-License-Identifier: Apache-2.0
// Inputs and targets that are no plain files, may not be read or written, or are the same file.
#include "files.h"
#include "hard_case.h"

#include <filesystem>

#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

using namespace vmlight;
namespace fs = std::filesystem;

namespace {

/// Puts something of a kind in a file's place while it exists.
class OddFile
{
public:
    OddFile(const std::string& kind, const std::string& name)
        : m_name(name)
    {
        if (kind == "folder")
            fs::create_directory(name);
        else if (kind == "pipe")
            EXPECT_EQ(::mkfifo(name.c_str(), 0600), 0);
        else if (kind == "socket")
            listen();
        else if (kind == "empty file")
            std::fclose(std::fopen(name.c_str(), "w"));
        else if (kind == "/dev/null")
            fs::create_symlink("/dev/null", name);
        else if (kind == "link to nothing")
            fs::create_symlink("nothing", name);
        else if (kind == "link to itself")
            fs::create_symlink(name, name);
        else
            EXPECT_EQ(kind, "missing");
    }
    OddFile(const OddFile&) = delete;
    ~OddFile()
    {
        ::close(m_socket);
        std::error_code ignored;
        fs::remove(m_name, ignored);
    }

private:
    void listen()
    {
        sockaddr_un address {};
        address.sun_family = AF_UNIX;
        m_name.copy(address.sun_path, sizeof(address.sun_path) - 1);
        m_socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
        EXPECT_EQ(::bind(m_socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    }

    std::string m_name;
    int m_socket = -1;
};

/// Root may read and write all files. While this exists, the process is nobody's.
class Nobody
{
public:
    Nobody()
    {
        if (!m_is_root)
            return;
        EXPECT_EQ(::setresgid(65534, 65534, 0), 0);
        EXPECT_EQ(::setresuid(65534, 65534, 0), 0);
    }
    Nobody(const Nobody&) = delete;
    ~Nobody()
    {
        if (!m_is_root)
            return;
        EXPECT_EQ(::setresuid(0, 0, 0), 0);
        EXPECT_EQ(::setresgid(0, 0, 0), 0);
        ::prctl(PR_SET_DUMPABLE, 1); // which those calls have taken away, and a search for leaks needs
    }

private:
    const bool m_is_root = ::geteuid() == 0;
};

} // namespace

TEST_F(Files, InputsThatAreNoFiles)
{
    HardCase row(
        "Each input missing, or a folder, a pipe, a socket, empty, /dev/null, a dangling link, a link to itself");
    write("material.obj", "mtllib named.mtl\n" + kQuad);
    const std::pair<std::string, std::string> inputs[] = {
        { "mesh.obj", "makevismap mesh.obj" },
        { "mesh.vismap", "makevismap mesh.vismap" },
        { "other.ply", "makevismap quad.obj --occluder other.ply" + small },
        { "light.exr", "makecfem light.exr" },
        { "light.cfem", "makecfem light.cfem" },
        { "map.exr", "makelightmap map.exr cfem.exr" },
        { "light.hdr", "makelightmap vm.exr light.hdr" },
        { "x.lightmap", "makelightmap x.lightmap" },
        { "paint.png", "makelightmap vm.exr cfem.exr --albedo paint.png" },
        { "c.ocio", "makecfem sky.exr --colorconfig c.ocio" },
        { "named.mtl", "makevismap material.obj" + small },
    };
    for (const auto& [name, line] : inputs)
        for (const char* kind : { "missing", "folder", "pipe", "socket", "empty file", "/dev/null", "link to nothing",
                                  "link to itself" }) {
            SCOPED_TRACE(name + " is " + kind);
            set_current_case(name + " is " + kind);
            restart_watchdog();
            const OddFile odd(kind, name);
            const Result result = run(line + " -o x.exr");
            if (name == "named.mtl") { // colours, which are not needed
                EXPECT_EQ(result.code, 0) << result.err;
                remove("x.exr");
            } else {
                expect_one_error(result, 1, name);
            }
            EXPECT_FALSE(exists("x.exr"));
        }
    row.naive("open() of a pipe blocks forever");
    row.ours("exit code 1, and one line naming the file");
}

TEST_F(Files, InputsThatMayNotBeRead)
{
    HardCase row("An unreadable input; a read-only output file or folder");
    const std::string folder = path("");
    fs::permissions(folder, fs::perms::all);
    fs::copy_file("sky.exr", "x.exr");
    const auto run_as_nobody = [&](const std::string& line) {
        const Nobody nobody;
        return run(line);
    };
    for (const auto& [name, line] : { std::pair<std::string, std::string>("quad.obj", "makevismap quad.obj"),
                                      { "sky.exr", "makecfem sky.exr" },
                                      { "vm.exr", "makelightmap vm.exr cfem.exr" } }) {
        ASSERT_EQ(::chmod(name.c_str(), 0), 0);
        expect_one_error(run_as_nobody(line + " -o y.exr"), 1, "\"" + name + "\": ");
        ASSERT_EQ(::chmod(name.c_str(), 0644), 0);
    }
    ASSERT_EQ(::chmod("x.exr", 0444), 0);
    const auto before = contents();
    expect_one_error(run_as_nobody("makecfem sky.exr -o x.exr"), 1, "\"x.exr\": not writable: Permission denied");
    EXPECT_TRUE(contents() == before);
    ASSERT_EQ(::chmod(folder.c_str(), 0555), 0);
    expect_one_error(run_as_nobody("makecfem sky.exr -o y.exr"), 1, "folder \".\" is not writable: Permission denied");
    ASSERT_EQ(::chmod(folder.c_str(), 0755), 0);
    EXPECT_TRUE(contents() == before);
    row.naive("a read-only file is replaced, because its folder is writable");
    row.ours("exit code 1 and one line, before the work");
}

TEST_F(Files, TargetIsAnInput)
{
    HardCase row("The output is one of the inputs");
    const std::string light = "makelightmap vm.exr cfem.exr ";
    for (const auto& [name, line] :
         { std::pair<std::string, std::string>("sky.exr", "makecfem sky.exr --resolution 8 "),
           { "vm.exr", light },
           { "cfem.exr", light } }) {
        const std::string old = read(name);
        done(line + "-o apart.exr");
        done(line + "-o " + name);
        EXPECT_TRUE(read(name) == read("apart.exr")) << name;
        write(name, old);
    }
    const auto before = contents();
    expect_one_error(run(light + "--model ao -o vm.exr"), 1);
    EXPECT_TRUE(contents() == before);
    row.naive("it is truncated before it is read");
    row.ours("the right image; the old input if the run fails");
}

TEST_F(Files, TargetsThatAreLinks)
{
    HardCase row("The output is a link, a dangling link, a cycle of links, or a file with two hard links");
    const std::string filter = "makecfem sky.exr --resolution 8 --quiet -o ";
    done(filter + "new.exr");
    const std::string fresh = read("new.exr");
    fs::create_directory("real");
    write("real/old.exr", "old");
    ASSERT_EQ(::chmod("real/old.exr", 0640), 0);
    fs::create_symlink("real/old.exr", "link.exr");
    fs::create_symlink("real/gone.exr", "dangling.exr");
    fs::create_hard_link("real/old.exr", "twin.exr");
    for (const std::string name : { "link.exr", "dangling.exr" }) {
        done(filter + name);
        EXPECT_TRUE(fs::is_symlink(name));
        EXPECT_TRUE(read(name) == fresh) << name;
    }
    EXPECT_EQ(read("twin.exr"), "old");
    EXPECT_EQ(fs::status("real/old.exr").permissions(), fs::perms(0640));
    fs::create_symlink("circle.exr", "circle.exr");
    expect_one_error(run(filter + "circle.exr"), 1, "\"circle.exr\": too many levels of symbolic links");
    EXPECT_THAT(names("", "real"), testing::ElementsAre("gone.exr", "old.exr"));
    row.naive("rename() replaces the link by a file, readable by everyone");
    row.ours(
        "the link's target is created or replaced and keeps its permissions; the second hard link keeps the old file");
}
