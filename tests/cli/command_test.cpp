// SPDX-License-Identifier: Apache-2.0
#include "command_test.h"

#include "captured.h"
#include "mains.h"

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace vmlight {
namespace {

namespace fs = std::filesystem;

// Steps that take more than a second print their progress, "bake  43 %  310 k texels/s  00:12 left": on a busy machine
// any may.
std::string without_progress(const std::string& err)
{
    std::string kept;
    for (size_t first = 0, last = 0; first < err.size(); first = last) {
        last = std::min(err.find('\n', first), err.size() - 1) + 1;
        const std::string line = err.substr(first, last - first);
        const size_t percent = line.find(" %  ");
        if (percent == std::string::npos || line.find(':', percent) == std::string::npos)
            kept += line;
    }
    return kept;
}

const std::map<std::string, Main> kMains { { "makevismap", makevismap_main },     { "makecfem", makecfem_main },
                                           { "makelightmap", makelightmap_main }, { "vmcost", vmcost_main },
                                           { "vmframes", vmframes_main },         { "vmexport", vmexport_main } };

// What mains do to a process that is theirs.
class ProcessState
{
public:
    ProcessState()
    {
        for (size_t i = 0; i < std::size(kSignals); ++i)
            ::sigaction(kSignals[i], nullptr, &m_actions[i]);
    }
    ProcessState(const ProcessState&) = delete;
    ~ProcessState()
    {
        for (size_t i = 0; i < std::size(kSignals); ++i)
            ::sigaction(kSignals[i], &m_actions[i], nullptr);
        OIIO::attribute("threads", 0);
    }

private:
    static constexpr int kSignals[] = { SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ };
    struct sigaction m_actions[std::size(kSignals)];
};

std::vector<std::string> words_of(const std::string& line)
{
    std::vector<std::string> words;
    bool quoted = false, within = false;
    for (const char c : line) {
        if (c == ' ' && !quoted) {
            within = false;
            continue;
        }
        if (!within)
            words.emplace_back();
        within = true;
        if (c == '\'')
            quoted = !quoted;
        else
            words.back() += c;
    }
    for (std::string& word : words)
        for (const auto& [name, path] :
             { std::pair<std::string, std::string>("{spot}", kSpot), { "{sky}", kSky }, { "{config}", kConfig } })
            word = OIIO::Strutil::replace(word, name, path);
    return words;
}

std::string text_of(const std::vector<std::string>& words)
{
    return OIIO::Strutil::join(words, " ");
}

} // namespace

CommandTest::CommandTest()
    : m_before(::open(".", O_RDONLY | O_DIRECTORY | O_CLOEXEC))
{
    std::string pattern = (fs::temp_directory_path() / "vmlight \u00fc XXXXXX").string();
    EXPECT_NE(::mkdtemp(pattern.data()), nullptr);
    m_folder = pattern;
    EXPECT_EQ(::chdir(m_folder.c_str()), 0);
}

CommandTest::~CommandTest()
{
    EXPECT_EQ(::fchdir(m_before), 0);
    ::close(m_before);
    std::error_code ignored;
    fs::remove_all(m_folder, ignored);
}

Result CommandTest::run_words(const std::vector<std::string>& words) const
{
    std::vector<const char*> pointers;
    for (const std::string& word : words)
        pointers.push_back(word.c_str());
    pointers.push_back(nullptr);
    const ProcessState state;
    const Captured out(STDOUT_FILENO, stdout), err(STDERR_FILENO, stderr);
    Result run;
    run.code = kMains.at(words.at(0))(int(words.size()), pointers.data());
    run.out = out.text();
    run.err = without_progress(err.text());
    return run;
}

Result CommandTest::run(const std::string& line) const
{
    return run_words(words_of(line));
}

std::string CommandTest::done(const std::string& line) const
{
    const Result result = run(line);
    EXPECT_EQ(result.code, 0) << line << "\n" << result.err;
    return result.all();
}

void CommandTest::refused(int code, const std::string& text, const std::string& line) const
{
    refused_words(code, text, words_of(line));
}

void CommandTest::refused_words(int code, const std::string& text, const std::vector<std::string>& words) const
{
    const auto before = contents();
    const Result result = run_words(words);
    EXPECT_EQ(result.code, code) << text_of(words) << "\n" << result.all();
    EXPECT_THAT(result.err, testing::HasSubstr(text)) << text_of(words);
    EXPECT_THAT(result.err, testing::StartsWith(words[0] + " ERROR: ")) << text_of(words);
    EXPECT_TRUE(contents() == before) << text_of(words)
                                      << ": something was left behind or changed: " << testing::PrintToString(names());
}

// Under a name of its own first: a file that is written over in place within a tick of the file system's clock keeps
// its stamp, and caches would take it for the old one.
std::string CommandTest::write(const std::string& name, const std::string& bytes) const
{
    const std::string fresh = path(name.substr(0, name.rfind('/') + 1) + ".fresh");
    std::ofstream(fresh, std::ios::binary) << bytes;
    EXPECT_EQ(std::rename(fresh.c_str(), path(name).c_str()), 0) << name;
    return name;
}

std::string CommandTest::read(const std::string& name) const
{
    std::ifstream file(path(name), std::ios::binary);
    EXPECT_TRUE(file.good()) << name;
    return std::string(std::istreambuf_iterator<char>(file), {});
}

bool CommandTest::exists(const std::string& name) const
{
    return fs::exists(fs::symlink_status(path(name)));
}

void CommandTest::remove(const std::string& name) const
{
    EXPECT_TRUE(fs::remove(path(name))) << name;
}

std::vector<std::string> CommandTest::names(const std::string& start, const std::string& folder) const
{
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(path(folder)))
        if (const std::string name = entry.path().filename().string(); OIIO::Strutil::starts_with(name, start))
            found.push_back(name);
    std::sort(found.begin(), found.end());
    return found;
}

std::map<std::string, std::string> CommandTest::contents() const
{
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(m_folder))
        if (entry.is_regular_file()) {
            std::ifstream file(entry.path(), std::ios::binary);
            found[entry.path().string()] = std::string(std::istreambuf_iterator<char>(file), {});
        }
    return found;
}

size_t count(const std::string& text, const std::string& part)
{
    size_t found = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++found;
    return found;
}

} // namespace vmlight
