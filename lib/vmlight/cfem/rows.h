// SPDX-License-Identifier: Apache-2.0
/// Both ends of a filter: the rows of an environment that it reads, and the image that its sums become.
#pragma once

#include <vmlight/base/bad_values.h>
#include <vmlight/cfem/environment.h>
#include <vmlight/cfem/grid.h>

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <string>
#include <vector>

namespace vmlight {

/// Rows of an environment's colour. NaN, infinite and negative values are counted, and repaired on request. Holds three
/// rows at a time.
class EnvironmentRows
{
public:
    /// If `env` is an image, it must outlive this.
    EnvironmentRows(Environment env, bool sanitize);

    /// False, with the reason in error(), if there is no colour to read.
    bool open();
    const EnvironmentGrid& grid() const { return m_grid; }

    /// Set `rgb` to the 3 x width floats of a row; call it for rows 0, 1, 2, ... in order. False, with the reason in
    /// error(), if the row cannot be read, or without `sanitize` has a bad value: then the remaining rows are read too,
    /// so that the message counts all bad values.
    bool read(int row, float* rgb);

    /// NaN, infinite and negative values so far.
    int64_t bad_values() const { return m_not_finite.count() + m_negative.count(); }
    const std::string& error() const { return m_error; }

private:
    bool load(int row);
    void repair(int row, float* rgb) const;
    std::vector<float>& window(int row) { return m_window[row % 3]; }
    const std::vector<float>& window(int row) const { return m_window[row % 3]; }

    const Environment m_env;
    bool m_sanitize;
    EnvironmentGrid m_grid;
    OIIO::ROI m_roi;
    std::array<int, 3> m_channels {}; // within m_roi
    std::vector<float> m_row; // all of m_roi's channels
    std::array<std::vector<float>, 3> m_window;
    std::array<bool, 3> m_window_bad {};
    int m_loaded = 0; // rows
    BadValues m_not_finite, m_negative;
    std::string m_error;
};

/// Set `dst` to a float image of `spec` with the values `rgb`, those below 0 as 0 if `clamp`. False, with the reason in
/// `error`, if one does not fit a float.
bool set_filtered(OIIO::ImageBuf& dst, const OIIO::ImageSpec& spec, const std::vector<double>& rgb, bool clamp,
                  std::string& error);

/// Set `vmlight:sanitized` to the number of values that were repaired, if any.
void record_sanitized(OIIO::ImageSpec& spec, int64_t values);

} // namespace vmlight
