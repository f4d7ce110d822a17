// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/flag_suggestion.h>

#include <vmlight/base/format.h>
#include <vmlight/base/params.h>
#include <vmlight/base/text.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <iterator>

namespace vmlight {
namespace {

constexpr size_t kMostSuggested = 3;
constexpr size_t kFewestLetters = 2; // of a beginning that says anything

// Words for the same thing in Blender, Substance, Marmoset, Arnold, maketx and oiiotool.
struct Synonyms
{
    const char* flag;
    std::vector<const char*> words;
};

const std::vector<Synonyms>& synonyms()
{
    static const std::vector<Synonyms> table {
        { "--samples", { "rays", "spp", "aa-samples", "ao-samples", "num-samples", "sample-count" } },
        { "--resolution", { "res", "size", "width", "image-size", "texture-size" } },
        { "--margin", { "dilation", "dilate", "padding", "edge-padding", "bleed", "gutter", "extend" } },
        { "--max-distance", { "distance", "max-dist", "ray-distance", "ao-distance", "far", "falloff" } },
        { "--environment", { "env", "hdri", "hdr", "sky", "ibl" } },
        { "--threads", { "jobs", "nthreads", "cores" } },
        { "--up", { "up-axis", "y-up", "z-up" } },
        { "--uv-set", { "uv", "uv-map", "uv-channel", "uv-index" } },
        { "--rotate", { "rotation", "env-rotation" } },
        { "--rotate-y", { "yaw" } },
        { "--model", { "shading-model" } },
        { "--colorconfig", { "ocio", "ocio-config", "config" } },
        { "--time-budget", { "time-limit", "max-time" } },
        { "--normal-map", { "normalmap", "bump" } },
        { "--occluder", { "blocker" } },
        { "-o", { "out", "outfile", "output-file", "output-path" } },
    };
    return table;
}

bool contains(const std::vector<std::string>& texts, const std::string& text)
{
    return std::find(texts.begin(), texts.end(), text) != texts.end();
}

std::string name_of(const std::string& flag)
{
    return flag.substr(std::min(flag.find_first_not_of('-'), flag.size()));
}

std::vector<std::string> synonyms_of(const std::string& name, const std::vector<std::string>& known)
{
    std::vector<std::string> found;
    for (const auto& [flag, words] : synonyms())
        if (contains(known, flag) && std::find(words.begin(), words.end(), name) != words.end())
            found.push_back(flag);
    return found;
}

template <class Alike> std::vector<std::string> flags_alike(const std::vector<std::string>& known, Alike alike)
{
    std::vector<std::string> found;
    std::copy_if(known.begin(), known.end(), std::back_inserter(found),
                 [&](const std::string& flag) { return alike(name_of(flag)); });
    if (found.size() > kMostSuggested)
        found.clear(); // it says too little
    return found;
}

std::vector<std::string> suggestions(const std::string& flag, const std::vector<std::string>& known)
{
    const std::string name = replaced(in_small_letters(name_of(flag)), "_", "-");
    std::vector<std::string> found = synonyms_of(name, known);
    if (name.size() < kFewestLetters)
        return found;
    if (found.empty())
        found = flags_alike(known, [&](const std::string& other) { return starts_with(other, name); });
    if (found.empty())
        if (const std::string near = nearest_name(flag, known); !near.empty())
            found.push_back(near);
    if (found.empty())
        found = flags_alike(known, [&](const std::string& other) { return contains(split(other, '-'), name); });
    return found;
}

} // namespace

std::string flag_suggestion(const std::string& flag, const std::vector<std::string>& known)
{
    const std::vector<std::string> found = suggestions(flag, known);
    return found.empty() ? "" : format("; did you mean {}?", OIIO::Strutil::join(found, " or "));
}

} // namespace vmlight
