// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/hash.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace vmlight {

/// Numbers keys in the order in which they first come; keys are equal if their bytes are.
template <class Key> class Numbering
{
public:
    explicit Numbering(size_t most_keys)
    {
        size_t slots = 16;
        while (slots < 2 * most_keys)
            slots *= 2;
        m_slots.assign(slots, kNone);
    }

    uint32_t number(const Key& key)
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

    const std::vector<Key>& keys() const { return m_keys; }

private:
    static constexpr uint32_t kNone = ~0u;
    std::vector<uint32_t> m_slots;
    std::vector<Key> m_keys;
};

} // namespace vmlight
