// SPDX-License-Identifier: Apache-2.0
/// A glTF file: its JSON, buffers and images. tinygltf reads the JSON; buffers are read here, since tinygltf refuses
/// external ones that are longer than stated, and the placeholders of compressed ones.
#pragma once

#include <vmlight/mesh/import/gltf/camera.h>
#include <vmlight/mesh/import/gltf/container.h>
#include <vmlight/mesh/import/importer.h>
#include <vmlight/mesh/tinygltf.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight::gltf {

/// Not thread-safe. Every function throws Error if the file is invalid.
class Document
{
public:
    /// Read and check the JSON: see is_nested_too_deep() and check_extensions(). Buffers are read when first asked for.
    /// @param request  must outlive the document
    /// @param builder  takes warnings; must outlive the document
    Document(const ImportRequest& request, MeshBuilder& builder);

    const tinygltf::Model& model() const { return m_model; }
    MeshBuilder& builder() { return m_builder; }

    /// The bytes of a buffer.
    Bytes buffer(int index);
    /// The bytes of a buffer view, decompressed if it is compressed.
    Bytes view(int index);
    /// From one element of a view to the next, in bytes; 0 if they are packed. Any number, whatever the specification
    /// allows.
    size_t stride(int view) const;
    /// Whether an accessor has a buffer view: without one it is zeros.
    bool has_view(int accessor) const { return m_has_view[size_t(accessor)]; }
    const std::vector<CameraShape>& cameras() const { return m_cameras; }
    /// How many there are, none of which is read.
    size_t animations() const { return m_animations; }
    /// Set where the image is in `texture`. If there is no such image, warns, and says so in
    /// `texture.missing`.
    void find_image(MaterialTexture& texture, int index);

private:
    struct Buffer
    {
        std::string uri;
        size_t length = 0;
        bool is_placeholder = false; ///< without bytes: all its views are compressed
        std::string own;
        Bytes bytes; ///< once it is loaded
    };
    struct Image
    {
        std::string uri;
        int view = -1;
    };

    void parse(const std::string& json);
    void check_view(int index) const;
    void load(Buffer& buffer, int index);
    std::string find_file(const std::string& uri, const std::string& what) const;

    const ImportRequest& m_request;
    MeshBuilder& m_builder;
    std::string m_file; // all of it
    Bytes m_binary;
    tinygltf::Model m_model; // less what is below, and animations
    std::vector<Buffer> m_buffers;
    std::vector<Image> m_images;
    std::vector<CameraShape> m_cameras;
    size_t m_animations = 0;
    std::vector<size_t> m_strides;
    std::vector<bool> m_has_view;
    std::vector<std::unique_ptr<std::vector<uint8_t>>> m_decompressed; // by view
};

} // namespace vmlight::gltf
