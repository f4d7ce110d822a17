// SPDX-License-Identifier: Apache-2.0
/// An EXR that is written atomically, whole or from the top down. Not installed.
#pragma once

#include <vmlight/base/output_file.h>
#include <vmlight/base/progress.h>
#include <vmlight/image/image_file.h>

#include <OpenImageIO/imageio.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// All of it returns false, with the reason and the path in `error`, on failure. Unless commit() succeeds, the path is
/// unchanged and no temporary file is left. The bytes depend on pixels, metadata and parameters only.
class ExrOutput
{
public:
    ExrOutput(const std::string& path, const FileParams& params);
    ~ExrOutput();

    /// Begin a file of several images, or of one. Metadata that depend on the machine or the date are left out.
    bool open(const std::vector<OIIO::ImageSpec>& images, std::string& error);
    /// Write image number `index`, after those before it. False also if `progress` stopped it.
    bool write_image(int index, const float* pixels, const Progress& progress, std::string& error);
    /// Write the rows from `ybegin` to `yend` - 1 of the only image, after those above them: whole rows of tiles.
    /// Refuses values beyond the range of half, if that is the format.
    bool write_rows(int ybegin, int yend, const float* pixels, std::string& error);
    /// Read the end of each image, and move the file into place.
    bool commit(std::string& error);

private:
    bool guard(const std::function<bool()>& work, std::string& error);
    bool fail(const std::string& reason, std::string& error) const;

    const std::string m_path;
    const FileParams m_params;
    std::unique_ptr<OutputFile> m_file;
    std::vector<OIIO::ImageSpec> m_specs;
    std::unique_ptr<OIIO::ImageOutput> m_out; // ends before the file
};

constexpr float kLargestHalf = 65504;

/// Why a channel that reaches `value` cannot be stored as half, or "".
std::string half_range_fault(const std::string& channel, float value);

} // namespace vmlight
