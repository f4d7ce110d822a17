// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/meshopt.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/gltf/document.h>
#include <vmlight/mesh/import/gltf/values.h>

#include <algorithm>
#include <iterator>

#include <meshoptimizer.h>

namespace vmlight::gltf {
namespace {

struct CompressedView
{
    size_t count, stride;
    Bytes bytes;
};

// What meshoptimizer asserts of its arguments is checked here.
struct Mode
{
    const char* name;
    bool (*fits)(const CompressedView& view);
    const char* needs; ///< what does not fit lacks
    size_t most_elements; ///< that a byte can hold
    int (*decode)(void* dst, size_t count, size_t stride, const unsigned char* bytes, size_t size);
};

bool is_index_size(size_t stride)
{
    return stride == 2 || stride == 4;
}

// A group of 16 bytes is at least a header of 2 bits.
const Mode kModes[] = {
    { "ATTRIBUTES", [](const CompressedView& v) { return v.stride > 0 && v.stride <= 256 && v.stride % 4 == 0; },
      "a byteStride of 4 to 256, a multiple of 4", 64, meshopt_decodeVertexBuffer },
    { "TRIANGLES", [](const CompressedView& v) { return is_index_size(v.stride) && v.count % 3 == 0; },
      "a byteStride of 2 or 4 and a count that is a multiple of 3", 3, meshopt_decodeIndexBuffer },
    { "INDICES", [](const CompressedView& v) { return is_index_size(v.stride); }, "a byteStride of 2 or 4", 1,
      meshopt_decodeIndexSequence },
};

struct Filter
{
    const char* name;
    bool (*fits)(size_t stride);
    void (*decode)(void* bytes, size_t count, size_t stride);
};

const Filter kFilters[] = {
    { "NONE", [](size_t) { return true; }, [](void*, size_t, size_t) {} },
    { "OCTAHEDRAL", [](size_t stride) { return stride == 4 || stride == 8; }, meshopt_decodeFilterOct },
    { "QUATERNION", [](size_t stride) { return stride == 8; }, meshopt_decodeFilterQuat },
    { "EXPONENTIAL", [](size_t stride) { return stride % 4 == 0; }, meshopt_decodeFilterExp },
};

template <class Entry, size_t Count>
const Entry& find_entry(const Entry (&table)[Count], const std::string& name, int view)
{
    const auto entry = std::find_if(std::begin(table), std::end(table), [&](const Entry& e) { return name == e.name; });
    if (entry == std::end(table))
        throw Error(format("buffer view {} is compressed with the unknown mode or filter \"{}\"", view, name));
    return *entry;
}

Bytes compressed_bytes(Document& document, const tinygltf::Value& extension, int view)
{
    const Bytes all = document.buffer(index_of(extension, "buffer"));
    const int offset = index_of(extension, "byteOffset", 0), length = index_of(extension, "byteLength");
    if (offset < 0 || length < 0 || size_t(offset) > all.size || size_t(length) > all.size - size_t(offset))
        throw Error(format("compressed buffer view {} is {} bytes from byte {} on of a buffer that has {}", view,
                           length, offset, all.size));
    return { all.data + offset, size_t(length) };
}

} // namespace

std::vector<uint8_t> decompress_meshopt(Document& document, const tinygltf::Value& extension, int view)
{
    const int count = index_of(extension, "count"), stride = index_of(extension, "byteStride");
    const Mode& mode = find_entry(kModes, string_of(extension, "mode", ""), view);
    const Filter& filter = find_entry(kFilters, string_of(extension, "filter", "NONE"), view);
    const CompressedView compressed { size_t(std::max(count, 0)), size_t(std::max(stride, 0)),
                                      compressed_bytes(document, extension, view) };
    if (count < 0 || !mode.fits(compressed))
        throw Error(format("compressed buffer view {} has count {} and byteStride {}; {} needs {}", view, count, stride,
                           mode.name, mode.needs));
    if (!filter.fits(compressed.stride))
        throw Error(format("compressed buffer view {} has byteStride {}, which the filter {} cannot have", view, stride,
                           filter.name));
    const bool is_attributes = mode.decode == meshopt_decodeVertexBuffer;
    const size_t elements = compressed.count * (is_attributes ? compressed.stride : 1);
    if (elements / mode.most_elements > compressed.bytes.size)
        throw Error(format("compressed buffer view {} claims {} elements of {} bytes, more than its {} bytes can hold",
                           view, count, stride, compressed.bytes.size));
    std::vector<uint8_t> bytes(compressed.count * compressed.stride);
    if (!bytes.empty()
        && mode.decode(bytes.data(), compressed.count, compressed.stride, compressed.bytes.data, compressed.bytes.size)
            != 0)
        throw Error(format("compressed buffer view {} is damaged", view));
    if (!bytes.empty())
        filter.decode(bytes.data(), compressed.count, compressed.stride);
    return bytes;
}

} // namespace vmlight::gltf
