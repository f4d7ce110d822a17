// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vmlight {

/// How far values are from what they should be.
class Difference
{
public:
    void add(double value, double truth)
    {
        m_square += (value - truth) * (value - truth);
        m_sum += truth;
        ++m_count;
    }

    int64_t count() const { return m_count; }
    /// Root of the mean square of the differences; 0 of no values.
    double rms() const { return std::sqrt(m_square / double(std::max<int64_t>(1, m_count))); }
    /// Of the values as they should be; 0 of no values.
    double mean() const { return m_sum / double(std::max<int64_t>(1, m_count)); }

private:
    double m_square = 0, m_sum = 0;
    int64_t m_count = 0;
};

} // namespace vmlight
