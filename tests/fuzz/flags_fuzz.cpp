// SPDX-License-Identifier: Apache-2.0
// Any words as the command lines of the executables, whose own mains run: each ends with 0, 1 or 2, a failure with one
// line on stderr, and what --print-recipe prints reads back to itself. No file is read or written: words have no '/',
// the folder is an empty one, stages print their recipe, and vmcost, which has none, never gets a place to write to.
//   flags_fuzz -max_total_time=60 NEW_CORPUS tests/fuzz/flags_corpus
#include "captured_run.h"
#include "law.h"

#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

using namespace vmlight;
using namespace vmlight::fuzz;

namespace {

template <class Recipe> void require_recipe(const std::string& text)
{
    Recipe recipe;
    std::string error;
    require(read_recipe_text(recipe, text, "x", error), "what is printed can be read", error + "\n" + text);
    require(recipe_text(recipe) == text, "what is printed reads back to the same", text + recipe_text(recipe));
}

struct Executable
{
    const char* name;
    Main main;
    void (*require_output)(const std::string& text);
};

constexpr std::array<Executable, 4> kExecutables { { { "makevismap", makevismap_main, require_recipe<VismapRecipe> },
                                                     { "makecfem", makecfem_main, require_recipe<CfemRecipe> },
                                                     { "makelightmap", makelightmap_main,
                                                       require_recipe<LightmapRecipe> },
                                                     { "vmcost", vmcost_main, nullptr } } };

// One to a line; a zero byte stays within a word's line and ends the word, as the system would.
std::vector<std::string> words_of(const std::string& text, bool is_stage)
{
    std::vector<std::string> words;
    for (std::string word : OIIO::Strutil::splits(text, "\n")) {
        word = word.substr(0, word.find('\0'));
        std::replace(word.begin(), word.end(), '/', '_');
        std::replace(word.begin(), word.end(), '\r', '\n'); // so that words can have several lines
        const bool names_output
            = OIIO::Strutil::starts_with(word, "-o") || OIIO::Strutil::starts_with(word, "--output");
        if (is_stage || !names_output)
            words.push_back(word);
    }
    return words;
}

bool asks_for_help(const std::vector<std::string>& words)
{
    static const std::vector<std::string> flags { "--help", "-h",       "-?",          "--version",
                                                  "-V",     "-version", "--print-man", "--print-completion" };
    return std::any_of(words.begin(), words.end(), [](const std::string& word) {
        return std::any_of(flags.begin(), flags.end(),
                           [&](const std::string& flag) { return OIIO::Strutil::starts_with(word, flag); });
    });
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    if (size == 0)
        return 0;
    const Executable& executable = kExecutables[data[0] % kExecutables.size()];
    std::vector<std::string> words = words_of({ data + 1, data + size }, executable.require_output != nullptr);
    words.insert(words.begin(), executable.name);
    if (executable.require_output)
        words.insert(words.begin() + 1, "--print-recipe");
    const CapturedRun run(executable.main, words);

    require(run.code >= 0 && run.code <= 2, "an exit code is 0, 1 or 2", std::to_string(run.code));
    if (run.code != 0) {
        const std::string start = std::string(executable.name) + " ERROR: ";
        require(OIIO::Strutil::starts_with(run.err, start) && run.err.size() > start.size() + 1
                    && run.err.back() == '\n',
                "a failure has a reason", run.err);
        require_reason(run.err.substr(0, run.err.size() - 1));
        require(run.out.empty(), "a failure prints nothing else", run.out);
    } else {
        require(run.err.empty(), "success has nothing to warn of", run.err);
        // A recipe of which every key has its default is an empty text.
        if (asks_for_help(words))
            require(!run.out.empty(), "help is printed", "");
        else
            executable.require_output(run.out);
    }
    return 0;
}
