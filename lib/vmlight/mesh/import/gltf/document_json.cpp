// SPDX-License-Identifier: Apache-2.0
// What a document reads of its JSON itself, and what tinygltf reads of the rest.
#include <vmlight/mesh/import/gltf/document.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/gltf/extensions.h>

#include <OpenImageIO/strutil.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <type_traits>
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

} // namespace vmlight::gltf
