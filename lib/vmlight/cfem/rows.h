// SPDX-License-Identifier: Apache-2.0
/// Rows of an environment's colour, checked on the way: NaN, infinite and negative values are counted, and mended if
/// asked. Holds three rows at a time.
#pragma once

#include <vmlight/base/faults.h>
#include <vmlight/cfem/environment.h>
#include <vmlight/cfem/grid.h>

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <string>
#include <vector>

namespace vmlight {

class EnvironmentRows
{
public:
    /// The image that `env` may be must outlive this.
    EnvironmentRows(Environment env, bool sanitize);

    /// False, with the reason in error(), if there is no colour to read.
    bool open();
    const EnvironmentGrid& grid() const { return m_grid; }

    /// Set `rgb` to the 3 x width floats of a row; to be called for rows 0, 1, 2, ... in order. False, with the reason
    /// in error(), if the row cannot be read, or if it holds a bad value that is not to be mended: then all rows that
    /// are left are read too, so that the reason counts every bad value.
    bool read(int row, float* rgb);

    /// Bad values met so far.
    int64_t bad_values() const { return m_not_finite.count() + m_negative.count(); }
    const std::string& error() const { return m_error; }

private:
    bool load(int row);
    void mend(int row, float* rgb) const;
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
    Faults m_not_finite, m_negative;
    std::string m_error;
};

} // namespace vmlight
