// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/progress.h>

#include <algorithm>
#include <utility>

namespace vmlight::cost {

/// One progress, and so one time left, for a run of many parts whose lengths are roughly known.
class WholeProgress
{
public:
    /// @param progress may be empty
    /// @param total    the weights of all parts
    WholeProgress(Progress progress, double total)
        : m_progress(std::move(progress))
        , m_left(total)
    {
    }
    WholeProgress(const WholeProgress&) = delete;

    /// A part that an earlier run has done takes no time: it counts neither as done nor as left.
    void skip(double weight) { m_left -= weight; }

    /// Start a part, which ends the one before. Its progress may be used until the next call, and may start anew:
    /// repeated work does not move the bar back.
    Progress part(double weight)
    {
        end_part();
        m_part = weight;
        return [this](double share) { return report(share); };
    }

    /// All is done.
    void finish()
    {
        end_part();
        if (m_progress)
            m_progress(1);
    }

private:
    void end_part()
    {
        m_done += m_part;
        m_left -= m_part;
        m_part = 0;
    }
    bool report(double share)
    {
        const double all = m_done + std::max(m_left, m_part);
        m_furthest = std::max(m_furthest, 0.999 * (m_done + share * m_part) / std::max(all, 1e-9));
        return !m_progress || m_progress(m_furthest);
    }

    const Progress m_progress;
    double m_left, m_done = 0, m_part = 0, m_furthest = 0;
};

} // namespace vmlight::cost
