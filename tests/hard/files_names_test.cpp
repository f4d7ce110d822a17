// SPDX-License-Identifier: Apache-2.0
// Odd names, long paths, and crowded folders.
#include "files.h"
#include "hard_case.h"

#include <vmlight/base/format.h>

#include <filesystem>

using namespace vmlight;
namespace fs = std::filesystem;

TEST_F(Files, Names)
{
    HardCase row(
        "File names with spaces, quotes, a newline, `%s`, `{}`, `*`, a leading `-`, invalid UTF-8 or 255 bytes");
    const std::string names[] = { "with space",
                                  " ",
                                  "quote'\"",
                                  "new\nline",
                                  "-o",
                                  "--help",
                                  "100%",
                                  "%s%n%d",
                                  "{}",
                                  "{0:9999}",
                                  "a&b",
                                  "tab\t",
                                  "\u00fc\u732b\U0001f408",
                                  "back\\slash",
                                  "*",
                                  "$HOME",
                                  "#",
                                  "####",
                                  ";",
                                  "<>",
                                  "..a",
                                  std::string(251, 'a'),
                                  "\xff\xfe" };
    for (const std::string& name : names) {
        SCOPED_TRACE(name);
        const std::string mesh = name + ".obj", image = name + ".exr", place = name[0] == '-' ? "./" : "";
        write(mesh, kQuad);
        Result result
            = run_words({ "makevismap", place + mesh, "-o", image, "--resolution", "16", "--samples", "4", "--quiet" });
        EXPECT_EQ(result.code, 0) << result.err;
        remove(mesh);
        result = run_words({ "makelightmap", place + image, "cfem.exr", "--quiet", "-o", "lit.exr" });
        EXPECT_EQ(result.code, 0) << result.err;
        remove(image);
    }
    row.naive("a format string, or a temporary file whose name is too long");
    row.ours("the same image");
}

TEST_F(Files, NamesOfMaterials)
{
    HardCase row(
        "Materials named `../a`, `a b`, `.`, `a/b` beside `a_b`, `100%`, or by 300 bytes, with `<MATERIAL>` in `-o`");
    fs::create_directory("maps");
    const auto bake = [&](const std::string& a, const std::string& b) {
        write("two.obj",
              OIIO::Strutil::replace(kQuad, "f 1", "usemtl " + a + "\nf 1") + "usemtl " + b
                  + "\nf 1/1/1 2/2/1 3/3/1\n");
        return run("makevismap two.obj -o 'maps/<MATERIAL>.exr'" + small);
    };
    EXPECT_EQ(bake("../a", "a b").code, 0);
    EXPECT_EQ(bake(".", "100%").code, 0);
    EXPECT_THAT(names("", "maps"), testing::ElementsAre("100_.exr", "_._a.exr", "_.exr", "a_b.exr"));
    const std::string before = read("maps/a_b.exr");
    expect_one_error(bake("a/b", "a_b"), 1, "would both be \"a_b\" in file names");
    EXPECT_EQ(read("maps/a_b.exr"), before);
    expect_one_error(bake("a", std::string(300, 'x')), 1, "File name too long");
    EXPECT_EQ(names("", "maps").size(), 4u);
    row.naive("files in other folders; one map overwrites the other");
    row.ours("`_` replaces what is not safe; two materials of one file name are refused before any work");
}

TEST_F(Files, QuestionMarks)
{
    HardCase row("A `?` in the name of a folder or a file, before a recipe's ?query, and in the query");
    for (const std::string folder : { "what?", "what?=why&", "old.vismap?samples=2" })
        for (const std::string name : { "a", "a?b", "a.vismap?samples=3" }) {
            const std::string place = folder + "/" + name;
            SCOPED_TRACE(place);
            fs::create_directory(folder);
            write(place + ".obj", kQuad);
            fs::copy_file("sky.exr", place + ".sky.exr");
            const auto quoted = [](const std::string& path) { return "'" + path + "'"; };
            done("makevismap " + quoted(place + ".obj") + small + " -o " + quoted(place + ".vm.exr"));
            write("plain.exr", read(place + ".vm.exr")); // a name that OIIO can open
            expect_same_pixels("plain.exr", "vm.exr", 0);
            done("makevismap " + quoted(place + ".obj") + small + " -o " + quoted(place + ".vismap"));
            done("makelightmap " + quoted(place + ".vismap?samples=5") + " " + quoted(place + ".sky.exr") + " -o "
                 + quoted(place + ".lightmap"));
            done("makelightmap " + quoted(place + ".lightmap?exposure=1") + " --quiet -o lit.exr");
            done("makevismap " + quoted(place + ".obj") + " --resolution 16 --samples 5 --quiet -o again.exr");
            done("makelightmap again.exr sky.exr --exposure 1 --quiet -o again_lit.exr");
            expect_same_pixels("lit.exr", "again_lit.exr", 0);
            EXPECT_EQ(attribute("lit.exr", "vmlight:environment"), name + ".sky.exr");
            fs::remove_all(folder);
        }
    expect_one_error(run("makevismap 'no?where/a.vismap?samples=3' -o x.exr"), 1,
                     "\"no?where/a.vismap\": no such file");
    expect_one_error(run("makecfem 'no?where/a.exr' -o x.exr"), 1, "\"no?where/a.exr\": no such file");
    row.naive("everything behind the first `?` is taken for a query: the file is not found, or another one is read");
    row.ours("a query starts at the first `?` behind the extension of a recipe that exists");
}

TEST_F(Files, RecipesThatAreNotThere)
{
    HardCase row("A misspelt recipe with a ?query that would do without it");
    const std::string keys = "mesh=quad.obj&resolution=16&samples=4";
    for (const std::string name : { "hreo.vismap", "none/hero.vismap", "hero.vismap?x.vismap" }) {
        const std::string path = name.substr(0, name.find('?'));
        expect_one_error(run("makevismap '" + name + "?" + keys + "' -o x.exr"), 1, "\"" + path + "\": no such file");
        EXPECT_THAT(read_by_plugin(name + "?" + keys), testing::HasSubstr("\"" + path + "\": no such file"));
    }
    row.naive("the query alone is the recipe: exit code 0 with another picture");
    row.ours("exit code 1: no such file, in executables and readers");
}

TEST_F(Files, LongPaths)
{
    HardCase row("A path of 4090 bytes; a file name of 256");
    std::string folder = fs::current_path().string();
    while (folder.size() + 201 < 3990)
        folder += "/" + std::string(200, 'd');
    fs::create_directories(folder);
    const std::string sky = folder + "/sky.exr";
    fs::copy_file("sky.exr", sky);
    const size_t rest = 4090 - folder.size() - std::string("/.exr").size();
    for (const size_t length : { rest - 10, rest }) {
        const std::string name = std::string(std::min(length, size_t(250)), 'f') + ".exr";
        const Result result = run_words({ "makecfem", sky, "-o", folder + "/" + name, "--resolution", "8", "--quiet" });
        EXPECT_EQ(result.code, 0) << result.err;
        std::vector<std::string> found;
        for (const auto& entry : fs::directory_iterator(folder))
            found.push_back(entry.path().filename().string());
        EXPECT_THAT(found, testing::UnorderedElementsAre("sky.exr", name));
        fs::remove(folder + "/" + name);
    }
    expect_one_error(run_words({ "makecfem", "sky.exr", "-o", std::string(252, 'f') + ".exr" }), 1,
                     "File name too long");
    expect_one_error(run_words({ "makecfem", "sky.exr", "-o", folder + "/" + std::string(200, 'f') + "/x.exr" }), 1);
    row.naive("the path of the temporary file exceeds the system's limit");
    row.ours("the image; exit code 1 before the work");
}

TEST_F(Files, TenThousandFiles)
{
    HardCase row("Two UDIM tiles among 10000 files with similar names");
    fs::create_directory("many");
    for (int i = 0; i < 10000; ++i)
        std::fclose(std::fopen(format("many/sky.{:05}.exr", i).c_str(), "w"));
    for (const std::string udim : { "1001", "1013" })
        fs::copy_file("sky.exr", "many/sky." + udim + ".exr");
    done("makecfem many/sky.<UDIM>.exr -o cfem.<UDIM>.exr --resolution 8");
    EXPECT_THAT(names("cfem."), testing::ElementsAre("cfem.1001.exr", "cfem.1013.exr", "cfem.exr"));
    done("makecfem sky.exr -o many/x.exr --resolution 8");
    row.naive("five-digit names are taken for tiles");
    row.ours("the two tiles, in well under 10 s");
}
