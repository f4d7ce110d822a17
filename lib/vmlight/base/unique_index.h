// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/hash.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace vmlight {

/// Gives distinct keys the indices 0, 1, 2, ... in the order in which they first occur. Keys are compared bytewise.
template <class Key> class UniqueIndex
{
public:
    /// @param expected     so many there will be, mostly: keys that must move for others are there twice meanwhile
    explicit UniqueIndex(size_t max_keys, size_t expected = 0)
    {
        size_t slots = 16;
        while (slots < 2 * max_keys)
            slots *= 2;
        m_slots.assign(slots, kNone);
        m_keys.reserve(expected);
    }

    /// The index of `key`, new if it has none yet.
    uint32_t index_of(const Key& key)
    {
        const char* bytes = reinterpret_cast<const char*>(&key);
        size_t slot = OIIO::farmhash::Fingerprint64(bytes, sizeof(Key)) & (m_slots.size() - 1);
        while (m_slots[slot] != kNone && std::memcmp(&m_keys[m_slots[slot]], &key, sizeof(Key)) != 0)
            slot = (slot + 1) & (m_slots.size() - 1);
        if (m_slots[slot] == kNone) {
            m_slots[slot] = uint32_t(m_keys.size());
            m_keys.push_back(key);
        }
        return m_slots[slot];
    }

    /// All keys, by index.
    const std::vector<Key>& keys() const { return m_keys; }

private:
    static constexpr uint32_t kNone = ~0u;
    std::vector<uint32_t> m_slots;
    std::vector<Key> m_keys;
};

} // namespace vmlight
