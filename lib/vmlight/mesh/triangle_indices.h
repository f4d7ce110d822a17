// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <vector>

namespace vmlight {

/// An index for each triangle, such as of its material. Held once while all are equal, as in the largest meshes.
class TriangleIndices
{
public:
    class const_iterator
    {
    public:
        using iterator_category = std::input_iterator_tag;
        using value_type = uint32_t;
        using difference_type = std::ptrdiff_t;
        using pointer = const uint32_t*;
        using reference = uint32_t;

        const_iterator(const TriangleIndices& indices, size_t triangle)
            : m_indices(&indices)
            , m_triangle(triangle)
        {
        }
        uint32_t operator*() const { return (*m_indices)[m_triangle]; }
        const_iterator& operator++()
        {
            ++m_triangle;
            return *this;
        }
        const_iterator operator++(int) { return { *m_indices, m_triangle++ }; }
        bool operator==(const const_iterator& other) const { return m_triangle == other.m_triangle; }
        bool operator!=(const const_iterator& other) const { return m_triangle != other.m_triangle; }

    private:
        const TriangleIndices* m_indices;
        size_t m_triangle;
    };
    using value_type = uint32_t;

    TriangleIndices() = default;
    TriangleIndices(const std::vector<uint32_t>& indices)
    {
        for (const uint32_t index : indices)
            push_back(index);
    }
    TriangleIndices(std::initializer_list<uint32_t> indices)
        : TriangleIndices(std::vector<uint32_t>(indices))
    {
    }

    size_t size() const { return m_count; }
    bool empty() const { return m_count == 0; }
    /// Not checked: that the triangle is below size().
    uint32_t operator[](size_t triangle) const { return m_each.empty() ? m_all : m_each[triangle]; }
    const_iterator begin() const { return { *this, 0 }; }
    const_iterator end() const { return { *this, size() }; }
    /// Of the memory that it holds.
    size_t bytes() const { return m_each.capacity() * sizeof(uint32_t); }

    void set(size_t triangle, uint32_t index)
    {
        if (m_each.empty() && index == m_all)
            return;
        hold_each();
        m_each[triangle] = index;
    }
    void push_back(uint32_t index)
    {
        if (empty())
            m_all = index;
        if (!m_each.empty() || index != m_all) {
            hold_each();
            m_each.push_back(index);
        }
        ++m_count;
    }
    /// How many there will be: of so many that differ, memory is allocated once.
    void reserve(size_t triangles) { m_expected = triangles; }
    void assign(size_t count, uint32_t index)
    {
        m_each.clear();
        m_count = count;
        m_all = index;
    }
    /// New triangles have the index 0.
    void resize(size_t count)
    {
        while (size() < count)
            push_back(0);
        if (!m_each.empty())
            m_each.resize(count);
        m_count = count;
    }
    void clear() { *this = {}; }

    friend bool operator==(const TriangleIndices& a, const TriangleIndices& b)
    {
        return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
    }

private:
    void hold_each()
    {
        if (!m_each.empty())
            return;
        m_each.reserve(m_expected);
        m_each.assign(m_count, m_all);
    }

    size_t m_count = 0, m_expected = 0;
    uint32_t m_all = 0; // while m_each is empty
    std::vector<uint32_t> m_each;
};

/// Those of some triangles, in their order; none if there are none to pick from.
template <class Index> TriangleIndices picked(const TriangleIndices& from, const std::vector<Index>& triangles)
{
    TriangleIndices to;
    for (size_t i = 0; i < triangles.size() && !from.empty(); ++i)
        to.push_back(from[size_t(triangles[i])]);
    return to;
}

} // namespace vmlight
