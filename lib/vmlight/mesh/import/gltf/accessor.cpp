// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/accessor.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/gltf/document.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace vmlight::gltf {
namespace {

template <class T>
void decode(double* dst, const uint8_t* bytes, bool normalized, size_t count, size_t components, size_t stride)
{
    const double largest = std::numeric_limits<T>::is_integer && normalized ? double(std::numeric_limits<T>::max()) : 1;
    for (size_t i = 0; i < count; ++i, bytes += stride)
        for (size_t k = 0; k < components; ++k) {
            T number;
            std::memcpy(&number, bytes + k * sizeof(T), sizeof(T));
            *dst++ = normalized ? std::max(double(number) / largest, -1.0) : double(number);
        }
}

struct ComponentType
{
    int id;
    size_t bytes;
    void (*decode)(double*, const uint8_t*, bool, size_t, size_t, size_t);
};

constexpr ComponentType kComponentTypes[] = {
    { TINYGLTF_COMPONENT_TYPE_BYTE, 1, decode<int8_t> },
    { TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 1, decode<uint8_t> },
    { TINYGLTF_COMPONENT_TYPE_SHORT, 2, decode<int16_t> },
    { TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 2, decode<uint16_t> },
    { TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, 4, decode<uint32_t> },
    { TINYGLTF_COMPONENT_TYPE_FLOAT, 4, decode<float> },
};

const ComponentType& component_type_of(int id)
{
    for (const ComponentType& type : kComponentTypes)
        if (type.id == id)
            return type;
    throw Error(format("{} is not a component type of glTF", id));
}

const tinygltf::Accessor& accessor_of(Document& document, int index, const std::string& what)
{
    const auto& accessors = document.model().accessors;
    if (index < 0 || size_t(index) >= accessors.size())
        throw Error(format("{} is accessor {}, but there are only {}", what, index, accessors.size()));
    return accessors[size_t(index)];
}

// Where `count` elements are in a view. Throws if it is shorter.
const uint8_t* elements_of(Document& document, int view, size_t offset, size_t count, size_t element, size_t stride,
                           const std::string& what)
{
    const Bytes bytes = document.view(view);
    const bool fits = offset <= bytes.size && element <= bytes.size - offset
        && (count - 1) <= (bytes.size - offset - element) / std::max<size_t>(stride, 1);
    if (!fits)
        throw Error(format("{}: {} elements of {} bytes do not fit buffer view {}, which has {} bytes", what, count,
                           element, view, bytes.size));
    return bytes.data + offset;
}

// Overwrite the elements that a sparse accessor lists.
void apply_sparse(Document& document, const tinygltf::Accessor& accessor, Numbers& numbers, const std::string& what)
{
    const auto& sparse = accessor.sparse;
    if (sparse.count < 0 || size_t(sparse.count) > numbers.count || sparse.indices.byteOffset < 0
        || sparse.values.byteOffset < 0)
        throw Error(format("{}: {} sparse elements of {}", what, sparse.count, numbers.count));
    if (sparse.count == 0)
        return;
    const size_t count = size_t(sparse.count);
    const ComponentType &index_type = component_type_of(sparse.indices.componentType),
                        &type = component_type_of(accessor.componentType);
    const size_t element = numbers.components * type.bytes;
    std::vector<double> indices(count), values(count * numbers.components);
    index_type.decode(indices.data(),
                      elements_of(document, sparse.indices.bufferView, size_t(sparse.indices.byteOffset), count,
                                  index_type.bytes, index_type.bytes, what),
                      false, count, 1, index_type.bytes);
    type.decode(values.data(),
                elements_of(document, sparse.values.bufferView, size_t(sparse.values.byteOffset), count, element,
                            element, what),
                accessor.normalized, count, numbers.components, element);
    for (size_t i = 0; i < count; ++i) {
        if (!(indices[i] >= 0 && indices[i] < double(numbers.count)))
            throw Error(format("{}: sparse element {} of {}", what, indices[i], numbers.count));
        std::copy_n(&values[i * numbers.components], numbers.components,
                    &numbers.values[size_t(indices[i]) * numbers.components]);
    }
}

} // namespace

Numbers read_accessor(Document& document, int index, int type, size_t count, const std::string& what)
{
    const tinygltf::Accessor& accessor = accessor_of(document, index, what);
    if (accessor.type != type)
        throw Error(format("{} has elements of {}, not {}", what,
                           count_text(tinygltf::GetNumComponentsInType(uint32_t(accessor.type)), "number", "numbers"),
                           tinygltf::GetNumComponentsInType(uint32_t(type))));
    if (count != 0 && accessor.count != count)
        throw Error(
            format("{} has {}, not {}", what, count_text(int64_t(accessor.count), "element", "elements"), count));
    const ComponentType& components = component_type_of(accessor.componentType);
    Numbers numbers { accessor.count, size_t(tinygltf::GetNumComponentsInType(uint32_t(type))), {} };
    const double bytes = double(accessor.count) * double(numbers.components) * sizeof(double);
    if (bytes > double(available_memory()))
        throw Error(format("{} has {} elements: more than memory holds", what, accessor.count));
    const size_t element = numbers.components * components.bytes;
    const uint8_t* source = nullptr;
    size_t stride = element;
    if (document.has_view(index) && accessor.count > 0) {
        if (const size_t given = document.stride(accessor.bufferView))
            stride = given;
        source = elements_of(document, accessor.bufferView, accessor.byteOffset, accessor.count, element, stride, what);
    }
    numbers.values.assign(accessor.count * numbers.components, 0.0);
    if (source)
        components.decode(numbers.values.data(), source, accessor.normalized, accessor.count, numbers.components,
                          stride);
    if (accessor.sparse.isSparse)
        apply_sparse(document, accessor, numbers, what);
    return numbers;
}

std::vector<uint32_t> read_indices(Document& document, int accessor)
{
    const Numbers numbers = read_accessor(document, accessor, TINYGLTF_TYPE_SCALAR, 0, "indices");
    const int type = document.model().accessors[size_t(accessor)].componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT
        && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        throw Error(format("indices are of component type {}; allowed: unsigned integers", type));
    std::vector<uint32_t> indices(numbers.count);
    std::transform(numbers.values.begin(), numbers.values.end(), indices.begin(),
                   [](double number) { return uint32_t(number); });
    return indices;
}

bool has_integers(Document& document, int accessor)
{
    return accessor_of(document, accessor, "an attribute").componentType != TINYGLTF_COMPONENT_TYPE_FLOAT;
}

bool has_normalized_integers(Document& document, int accessor)
{
    return has_integers(document, accessor) && document.model().accessors[size_t(accessor)].normalized;
}

} // namespace vmlight::gltf
