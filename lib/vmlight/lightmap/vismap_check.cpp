// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/vismap_check.h>

#include <vmlight/base/parallel.h>
#include <vmlight/base/text_format.h>
#include <vmlight/image/channels.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <mutex>

namespace vmlight {
namespace {

// Half floats round V and B by 2^-11 each; smaller ones in steps of 2^-24.
constexpr float kRelative = 1e-3f, kAbsolute = 1e-6f;
constexpr double kMostImpossible = 1e-3, kMostShort = 0.9, kOddlyShort = 0.3;
// Below that V, 2/3 - (1 - V) says little.
constexpr float kBright = 0.4f, kShort = 0.01f;

struct Verdict
{
    bool any, impossible, bright, too_short;
};

// NaN answers no to all: it is reported as such.
Verdict judge(float v, float x, float y, float z)
{
    const float square = x * x + y * y + z * z;
    const float most = v * (1 + kRelative) + kAbsolute, least = std::max(0.0f, v - (1.0f / 3 + kShort));
    const bool bright = v > kBright;
    return { v != 0 || square != 0, v < -kAbsolute || v > 1 + kRelative || square > most * most, bright,
             bright && square < least * least };
}

std::string percent(int64_t part, int64_t whole)
{
    return format("{:.2g} %", 100.0 * double(part) / double(whole));
}

std::string impossible_text(const VismapDoubts& doubts)
{
    const int64_t count = doubts.impossible.count();
    return format("{} of {} ({}) cannot be visibility, {}at ({}, {}): V is outside [0, 1] or |B| is larger than V",
                  count, count_text(doubts.texels, "texel", "texels"), percent(count, doubts.texels),
                  count == 1 ? "" : "the first ", doubts.impossible.x(), doubts.impossible.y());
}

// What a lossy compression that the header names has done to the map, or "".
std::string compression_doubt(const OIIO::ImageSpec& spec)
{
    const std::string compression = spec.get_string_attribute("compression");
    const auto is_half = [&](int c) { return spec.channelformat(c) == OIIO::TypeDesc::HALF; };
    bool half = false;
    for (int c = 0; c < spec.nchannels; ++c)
        half |= is_half(c);
    if (!half || !OIIO::Strutil::istarts_with(compression, "b44"))
        return "";
    return format(
        "stored as half with the compression {}, which opens closed texels and turns B by up to 14 degrees; zip, "
        "dwaa, dwab and pxr24 are safe",
        compression);
}

} // namespace

void VismapDoubts::merge(const VismapDoubts& other)
{
    texels += other.texels;
    impossible.merge(other.impossible);
    bright += other.bright;
    too_short += other.too_short;
}

void count_doubts(VismapDoubts& dst, OIIO::ROI roi, const float* texels, int channels, const std::array<int, 4>& index)
{
    const auto [v, x, y, z] = index;
    for (int row = roi.ybegin; row < roi.yend; ++row) {
        int any = 0, impossible = 0, bright = 0, too_short = 0;
        const float* const first = texels;
        for (int i = 0; i < roi.width(); ++i, texels += channels) {
            const Verdict verdict = judge(texels[v], texels[x], texels[y], texels[z]);
            any += verdict.any;
            impossible += verdict.impossible;
            bright += verdict.bright;
            too_short += verdict.too_short;
        }
        dst.texels += any;
        dst.bright += bright;
        dst.too_short += too_short;
        const float* texel = first;
        for (int i = roi.xbegin; impossible > 0 && i < roi.xend; ++i, texel += channels)
            if (judge(texel[v], texel[x], texel[y], texel[z]).impossible)
                dst.impossible.add(i, row, 0);
    }
}

std::string impossible_fault(const VismapDoubts& doubts, const OIIO::ImageSpec& stored)
{
    if (double(doubts.impossible.count()) <= kMostImpossible * double(doubts.texels))
        return "";
    const std::string compression = compression_doubt(stored);
    return impossible_text(doubts) + "; "
        + (compression.empty()
               ? "was the map resized by a filter that rings (lanczos, sinc, catmull-rom, mitchell), or "
                 "converted as if it were colour? Use a box filter, the default of maketx, or bake it again"
               : "it is " + compression);
}

bool check_vismap(const OIIO::ImageBuf& map, const OIIO::ImageSpec& stored, int nthreads,
                  std::vector<std::string>& warnings, std::string& error)
{
    std::array<int, 4> index;
    if (!find_vismap_channels(map.spec(), index, error))
        return false;
    const auto* const pixels = static_cast<const float*>(map.localpixels());
    const OIIO::ROI all = map.roi();
    const int rows = std::max(1, 16384 / all.width()), channels = map.nchannels();
    VismapDoubts doubts;
    std::mutex mutex;
    parallel_items((all.height() + rows - 1) / rows, nthreads, [&](int64_t item, int) {
        OIIO::ROI roi = all;
        roi.ybegin = all.ybegin + int(item) * rows;
        roi.yend = std::min(roi.ybegin + rows, all.yend);
        VismapDoubts own;
        count_doubts(own, roi, pixels + size_t(item) * size_t(rows) * size_t(all.width()) * size_t(channels), channels,
                     index);
        const std::lock_guard<std::mutex> lock(mutex);
        doubts.merge(own);
    });
    const int64_t bright = std::max<int64_t>(1, doubts.bright);
    // B of an open strand is 0.
    const double short_share = kernel_of(map.spec()) == kStrandKernel ? 0 : double(doubts.too_short) / double(bright);
    const std::string short_text = format(
        "in {} of the texels with V > 0.4, |B| is smaller than 2/3 - (1 - V), as it is at no point of a surface",
        percent(doubts.too_short, bright));
    error = impossible_fault(doubts, stored);
    if (error.empty() && short_share > kMostShort)
        error = short_text + ": the map was converted as if it were colour; bake it again";
    if (!error.empty())
        return false;
    if (const std::string compression = compression_doubt(stored); !compression.empty())
        warnings.push_back(compression);
    if (doubts.impossible.any())
        warnings.push_back(impossible_text(doubts));
    if (short_share > kOddlyShort)
        warnings.push_back(
            short_text
            + ": was the map converted as if it were colour? One that was reduced to 1/16 of its size or "
              "less may have them too");
    return true;
}

} // namespace vmlight
