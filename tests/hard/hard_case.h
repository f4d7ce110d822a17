// SPDX-License-Identifier: Apache-2.0
/// Rows of the table in README.md. Each is written by the test that it tells of, once that has passed.
#pragma once

#include <string>
#include <utility>

namespace vmlight {

/// What is hard, what a naive implementation makes of it, and what vmlight does. Stands at the head of a test, whose
/// suite is the row's family; a test that fails or is skipped writes no row.
///
/// Figures are those that the test has just measured, rounded until they are the same on every machine.
class HardCase
{
public:
    /// @param what     a sentence
    /// @param peers    what others do, with where that is told; "" where nothing is known
    explicit HardCase(std::string what, std::string peers = "")
        : m_what(std::move(what))
        , m_peers(std::move(peers))
    {
    }
    HardCase(const HardCase&) = delete;
    ~HardCase() { write(); }

    void naive(const std::string& result) { m_naive = result; }
    void ours(const std::string& result) { m_ours = result; }

private:
    void write() const;

    std::string m_what, m_peers, m_naive, m_ours;
};

} // namespace vmlight
