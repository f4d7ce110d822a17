// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/document.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/gltf/hierarchy.h>
#include <vmlight/mesh/import/gltf/meshopt.h>
#include <vmlight/mesh/import/gltf/uri.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <utility>

namespace vmlight::gltf {
namespace {

Bytes bytes_of(const std::string& text)
{
    return { reinterpret_cast<const uint8_t*>(text.data()), text.size() };
}

} // namespace

Document::Document(const ImportRequest& request, MeshBuilder& builder)
    : m_request(request)
    , m_builder(builder)
{
    if (request.before_open)
        request.before_open(request.path);
    m_file = file_bytes(request.path);
    const Container parts = split_file(m_file);
    m_binary = parts.binary;
    if (is_nested_too_deep(parts.json))
        throw Error("JSON is nested more than 1000 deep");
    parse(parts.json);
    if (!m_binary.data)
        m_file = std::string(); // its JSON is parsed
}

std::string Document::find_file(const std::string& uri, const std::string& what) const
{
    if (const std::string scheme = uri_scheme(uri); !scheme.empty())
        throw Error(format("{} is at \"{}\": only files beside the mesh can be read, not \"{}:\"", what,
                           shortened_line(uri), scheme));
    const std::string folder = OIIO::Filesystem::parent_path(m_request.path);
    const auto path_of = [&](const std::string& name) {
        return folder.empty() || OIIO::Filesystem::path_is_absolute(name) ? name : folder + "/" + name;
    };
    const std::string decoded = decode_percent(uri);
    // Some writers do not encode names, and some separate folders by backslashes.
    for (std::string name : { decoded, uri, OIIO::Strutil::replace(decoded, "\\", "/", true) })
        if (OIIO::Filesystem::is_regular(path_of(name)))
            return path_of(name);
    throw Error(format("{}: \"{}\" {}", what, path_of(decoded),
                       OIIO::Filesystem::exists(path_of(decoded)) ? "is not a file" : "does not exist"));
}

void Document::load(Buffer& buffer, int index)
{
    const std::string what = format("buffer {}", index);
    if (buffer.uri.empty() && index == 0 && m_binary.data) {
        buffer.bytes = m_binary;
    } else if (buffer.uri.empty()) {
        throw Error(format("{} has no data{}", what, buffer.is_placeholder ? ": it is a placeholder" : ""));
    } else {
        if (OIIO::Strutil::istarts_with(buffer.uri, "data:")) {
            if (!decode_data_uri(buffer.own, buffer.uri))
                throw Error(format("{} has an invalid data URI", what));
            buffer.uri = "data:"; // may be large
        } else {
            const std::string path = find_file(buffer.uri, what);
            if (m_request.before_open)
                m_request.before_open(path);
            buffer.own = file_bytes(path);
        }
        buffer.bytes = bytes_of(buffer.own);
    }
    if (buffer.bytes.size < buffer.length)
        throw Error(format("{} ends early: {} bytes of {}", what, buffer.bytes.size, buffer.length));
    buffer.bytes.size = buffer.length;
}

Bytes Document::buffer(int index)
{
    if (index < 0 || size_t(index) >= m_buffers.size())
        throw Error(format("there is no buffer {}", index));
    Buffer& buffer = m_buffers[size_t(index)];
    if (!buffer.bytes.data)
        load(buffer, index);
    return buffer.bytes;
}

void Document::check_view(int index) const
{
    if (index < 0 || size_t(index) >= m_strides.size())
        throw Error(format("there is no buffer view {}", index));
}

Bytes Document::view(int index)
{
    check_view(index);
    const tinygltf::BufferView& view = m_model.bufferViews[size_t(index)];
    if (const auto meshopt = view.extensions.find("EXT_meshopt_compression"); meshopt != view.extensions.end()) {
        auto& bytes = m_decompressed[size_t(index)];
        if (!bytes)
            bytes = std::make_unique<std::vector<uint8_t>>(decompress_meshopt(*this, meshopt->second, index));
        return { bytes->data(), bytes->size() };
    }
    const Bytes all = buffer(view.buffer);
    if (view.byteOffset > all.size || view.byteLength > all.size - view.byteOffset)
        throw Error(format("buffer view {} is bytes {} to {} of buffer {}, which has {}", index, view.byteOffset,
                           double(view.byteOffset) + double(view.byteLength), view.buffer, all.size));
    return { all.data + view.byteOffset, view.byteLength };
}

size_t Document::stride(int view) const
{
    check_view(view);
    return m_strides[size_t(view)];
}

void Document::find_image(MaterialTexture& texture, int index)
{
    if (index < 0 || size_t(index) >= m_images.size()) {
        texture.missing = format("there is no image {}", index);
        m_builder.warn(texture.missing);
        return;
    }
    const Image& image = m_images[size_t(index)];
    try {
        if (OIIO::Strutil::istarts_with(image.uri, "data:")) {
            std::string bytes;
            if (!decode_data_uri(bytes, image.uri))
                throw Error(format("image {} has an invalid data URI", index));
            texture.embedded = std::make_shared<const std::string>(std::move(bytes));
        } else if (!image.uri.empty()) {
            texture.path = find_file(image.uri, format("image {}", index));
        } else {
            const Bytes bytes = view(image.view);
            const Bytes file = bytes_of(m_file);
            if (bytes.data >= file.data && bytes.data < file.data + file.size) {
                texture.path = m_request.path;
                texture.offset = uint64_t(bytes.data - file.data);
                texture.length = bytes.size;
            } else {
                texture.embedded = std::make_shared<const std::string>(bytes.data, bytes.data + bytes.size);
            }
        }
    } catch (const Error& error) {
        texture.missing = error.what();
        m_builder.warn(error.what());
    }
}

} // namespace vmlight::gltf
