// SPDX-License-Identifier: Apache-2.0
/// Inputs of shading, of any pixel type, channel order and storage.
#pragma once

#include <vmlight/base/bad_values.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/lightmap/model.h>

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <string>
#include <vector>

namespace vmlight {

/// `reason` after the image's name in quotes, if it has one.
std::string named(const OIIO::ImageBuf& image, const std::string& reason);

/// False, with the reason in `error`, if `image` cannot be read, or is deep or a volume. `what` names what was
/// expected.
bool check_input(const OIIO::ImageBuf& image, const char* what, std::string& error);

/// Add the NaN and infinite values of `pixels`, which hold `roi` with `channels` channels.
void find_not_finite(OIIO::ROI roi, const float* pixels, int channels, BadValues& faults);

/// Reads a visibility map as a model takes it: the floats of a texel side by side, in the model's order of channels.
class VismapReader
{
public:
    /// Set `model` to what `params` ask for of this map, by choose_model(). False, with the reason in `error`, if
    /// `image` is not a visibility map or lacks a channel that the model reads. It must outlive the reader.
    bool open(const OIIO::ImageBuf& image, const LightmapParams& params, bool has_stack, ShadingModel& model,
              std::string& error);

    TexelLayout layout() const { return m_layout; }

    /// Floats of a texel.
    int channels() const { return int(m_index.size()); }

    /// Texels of `roi`, which spans whole rows: in place if memory already holds them as the model takes them, else
    /// copied to `scratch`. nullptr, with the reason in `error`, if they cannot be read.
    const float* read(OIIO::ROI roi, std::vector<float>& scratch, std::string& error) const;

    std::string name() const { return m_image->name(); }

private:
    // Channels side by side in the image that are side by side in the model.
    struct Run
    {
        int from, count;
    };

    void gather(float* dst, const float* texel, int stride, size_t texels) const;

    const OIIO::ImageBuf* m_image = nullptr;
    const float* m_pixels = nullptr; // of all channels, if they are floats in memory without gaps
    bool m_is_in_place = false;
    std::vector<int> m_index;
    int m_first = 0, m_end = 0; // of the image's channels, those that are read
    std::vector<Run> m_runs; // from m_first
    TexelLayout m_layout = TexelLayout::visibility_first;
};

/// Multiplies by an albedo: colour, or one channel for all three.
class AlbedoReader
{
public:
    /// The albedo's display window is the texture, black where the file stores no pixels. If its size differs, it is
    /// resized to `roi` by a triangle filter, which does not ring. False, with the reason in `error`, if check_window()
    /// refuses it, it has no colour, or it must be resized and has a value that is negative or not finite.
    bool open(const OIIO::ImageBuf& image, OIIO::ROI roi, int nthreads, std::string& error);

    /// Multiply `rgb`, the pixels of `roi`. Values that are negative or not finite are added to `faults`; `error` is
    /// set if the albedo cannot be read.
    void multiply(OIIO::ROI roi, float* rgb, std::vector<float>& scratch, BadValues& faults, std::string& error) const;

    /// Whether every pixel is 1, so that it multiplies nothing. Reads pixels until one is not.
    bool is_one() const;

    /// Set `low` and `high` to the least and the most of its colours. False if it cannot be read.
    bool find_range(float& low, float& high) const;

    std::string fault_text(const BadValues& faults) const;

private:
    bool read(OIIO::ROI roi, std::vector<float>& scratch, BadValues& faults, std::string& error) const;
    bool read_of_map(int first, int last, int y, std::vector<float>& colors) const;

    const OIIO::ImageBuf* m_original = nullptr; // as given, for messages
    const OIIO::ImageBuf* m_image = nullptr; // the original, or the resized copy
    OIIO::ImageBuf m_resized;
    std::array<int, 3> m_index {};
    OIIO::ROI m_map; // pixels of the map
    int m_dx = 0, m_dy = 0; // from the map's pixel coordinates to those of m_image
};

} // namespace vmlight
