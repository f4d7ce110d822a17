// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/document.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/gltf/extensions.h>
#include <vmlight/mesh/import/gltf/hierarchy.h>
#include <vmlight/mesh/import/gltf/meshopt.h>
#include <vmlight/mesh/import/gltf/uri.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace vmlight::gltf {
namespace {

using nlohmann::json;

template <class T> T member(const json& object, const char* name, T otherwise)
{
    const auto found = object.find(name);
    if (found == object.end())
        return otherwise;
    if constexpr (std::is_same_v<T, std::string>)
        return found->is_string() ? found->get<T>() : otherwise;
    else if constexpr (std::is_same_v<T, bool>)
        return found->is_boolean() ? found->get<T>() : otherwise;
    else if constexpr (std::is_same_v<T, double>)
        return found->is_number() ? found->get<T>() : otherwise;
    else
        return found->is_number_unsigned() ? T(found->get<uint64_t>()) : otherwise;
}

// The objects of an array of the root. Throws if something else is in it.
std::vector<json*> objects_of(json& root, const char* name)
{
    std::vector<json*> objects;
    const auto array = root.find(name);
    if (array == root.end())
        return objects;
    if (!array->is_array())
        throw Error(format("\"{}\" is not an array", name));
    for (json& element : *array) {
        if (!element.is_object())
            throw Error(format("{} of \"{}\" is not an object", objects.size(), name));
        objects.push_back(&element);
    }
    return objects;
}

// What is no camera has no type, and nothing is thrown: pictures are not what the mesh is read for.
std::vector<CameraShape> cameras_of(const json& root)
{
    std::vector<CameraShape> cameras;
    const auto array = root.find("cameras");
    if (array == root.end() || !array->is_array())
        return cameras;
    const auto part_of = [](const json& camera, const char* name) {
        const auto found = camera.is_object() ? camera.find(name) : camera.end();
        return found != camera.end() && found->is_object() ? *found : json::object();
    };
    for (const json& element : *array) {
        const json camera = element.is_object() ? element : json::object();
        const json lens = part_of(camera, "perspective"), flat = part_of(camera, "orthographic");
        cameras.push_back({ member(camera, "name", std::string()), member(camera, "type", std::string()),
                            member(lens, "yfov", 0.0), member(lens, "aspectRatio", 0.0), member(flat, "xmag", 0.0),
                            member(flat, "ymag", 0.0) });
    }
    return cameras;
}

Bytes bytes_of(const std::string& text)
{
    return { reinterpret_cast<const uint8_t*>(text.data()), text.size() };
}

bool is_compression_placeholder(const json& buffer)
{
    const auto extensions = buffer.find("extensions");
    if (extensions == buffer.end() || !extensions->is_object())
        return false;
    const auto meshopt = extensions->find("EXT_meshopt_compression");
    return meshopt != extensions->end() && meshopt->is_object() && member(*meshopt, "fallback", false);
}

void check_version(const json& root)
{
    const auto asset = root.find("asset");
    const std::string version
        = asset != root.end() && asset->is_object() ? member(*asset, "version", std::string()) : "";
    if (!OIIO::Strutil::starts_with(version, "2."))
        throw Error(version.empty() ? "has no asset.version" : format("glTF version {}; supported: 2.0", version));
    const std::string least = member(*asset, "minVersion", std::string("2.0"));
    if (least != "2.0")
        throw Error(format("needs a reader of glTF {}; supported: 2.0", least));
}

std::vector<std::string> strings_of(const json& root, const char* name)
{
    std::vector<std::string> strings;
    if (const auto array = root.find(name); array != root.end() && array->is_array())
        for (const json& element : *array)
            if (element.is_string())
                strings.push_back(element.get<std::string>());
    return strings;
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

void Document::parse(const std::string& text)
{
    json root;
    try {
        root = json::parse(text);
    } catch (const json::exception& exception) {
        throw Error(format("invalid JSON: {}", exception.what()));
    }
    if (!root.is_object())
        throw Error("invalid JSON: not an object");
    check_version(root);
    check_extensions(strings_of(root, "extensionsUsed"), strings_of(root, "extensionsRequired"), m_builder);

    for (json* object : objects_of(root, "buffers")) {
        Buffer buffer;
        buffer.uri = member(*object, "uri", std::string());
        buffer.length = member(*object, "byteLength", size_t(0));
        buffer.is_placeholder = buffer.uri.empty() && is_compression_placeholder(*object);
        m_buffers.push_back(std::move(buffer));
    }
    for (json* object : objects_of(root, "images"))
        m_images.push_back({ member(*object, "uri", std::string()), int(member(*object, "bufferView", int64_t(-1))) });
    m_cameras = cameras_of(root);
    if (const auto found = root.find("animations"); found != root.end() && found->is_array())
        m_animations = found->size();
    for (json* view : objects_of(root, "bufferViews")) {
        m_strides.push_back(member(*view, "byteStride", size_t(0)));
        view->erase("byteStride"); // tinygltf refuses those that are no multiple of 4
    }
    m_decompressed.resize(m_strides.size());

    // tinygltf wants a buffer view of each accessor that has indices, and buffers whose bytes it finds.
    const json one_byte = { { "byteLength", 1 }, { "uri", "data:application/octet-stream;base64,AA==" } };
    const size_t view_count = m_strides.size();
    for (json* accessor : objects_of(root, "accessors")) {
        m_has_view.push_back(accessor->contains("bufferView"));
        if (!m_has_view.back())
            (*accessor)["bufferView"] = view_count;
    }
    root["bufferViews"].push_back({ { "buffer", 0 }, { "byteLength", 1 } });
    root["buffers"] = json::array();
    for (size_t i = 0; i < std::max<size_t>(m_buffers.size(), 1); ++i)
        root["buffers"].push_back(one_byte);
    for (const char* unused :
         { "images", "animations", "cameras", "extensions", "extras", "extensionsUsed", "extensionsRequired" })
        root.erase(unused);

    const std::string rest = root.dump();
    std::string error, warning;
    if (rest.size() > UINT32_MAX)
        throw Error("more than 4 GiB of JSON");
    if (!tinygltf::TinyGLTF().LoadASCIIFromString(&m_model, &error, &warning, rest.data(), unsigned(rest.size()), ""))
        throw Error(error.empty() ? "tinygltf cannot read it" : error);
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
