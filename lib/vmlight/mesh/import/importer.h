// SPDX-License-Identifier: Apache-2.0
/// The seam between mesh files and the libraries that read them. A format is one entry of mesh_formats() (formats.cpp)
/// and a file of its own; which library reads it is that file's business.
#pragma once

#include <vmlight/mesh/import/mesh_builder.h>
#include <vmlight/mesh/mesh.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace vmlight {

/// The start of a file, which its format is detected by.
struct FileHead
{
    static constexpr size_t kBytes = 4096;

    std::string bytes; ///< the first kBytes of the file, or all of it
    uint64_t size = 0; ///< of the whole file, in bytes
};

/// What a format's own check of a file found, before the library that reads it sees the file.
struct Inspection
{
    /// Why the library must not see the file, on one line, or "".
    std::string error;
};

/// Called with the path of a file before it is opened.
using BeforeOpen = std::function<void(const std::string& path)>;

struct MeshFormat;

/// A file to read, once its format is known and its inspection has no error.
struct ImportRequest
{
    std::string path;
    const MeshFormat& format;
    FileHead head;
    Inspection inspection;
    /// Call it for each file: the mesh itself, and what it refers to (buffers, materials). May be empty.
    BeforeOpen before_open;
    /// What is shown in several places goes to Mesh::instances where the format knows of it; else all is triangles.
    bool keeps_instances = false;
};

/// A mesh format.
struct MeshFormat
{
    /// As messages and documentation name it: "glTF 2.0".
    const char* name;
    /// Lower case, separated by blanks, the usual one first: "gltf glb". They count only where content cannot tell.
    const char* extensions;
    /// Is a file that starts like this certainly of this format? nullptr if content cannot tell.
    bool (*has_content)(const FileHead& head);
    /// Check all bytes of a file before it is read. nullptr if the library can be given any file.
    Inspection (*inspect)(const std::string& bytes);
    /// Read every mesh of a file, each at its place in the node hierarchy, into `dst`. All that the library allocates
    /// is freed before it returns. Runs on a deep stack: see run_on_deep_stack().
    /// @returns false, with the reason in `error` (on one line, without the path), if the file cannot be read
    bool (*read)(MeshBuilder& dst, const ImportRequest& request, std::string& error);
    /// Does it hold meshes that change over time? Their `read` follows MeshParams::frame.
    bool has_time = false;
    /// Are its files images of heights? Their `read` follows MeshParams::terrain.
    bool has_heights = false;
};

/// Every format that read_mesh() reads.
const std::vector<MeshFormat>& mesh_formats();

/// The format of a file: the first entry that recognises its content, else the first that lists its extension (in any
/// case), else nullptr.
const MeshFormat* find_mesh_format(const std::vector<MeshFormat>& formats, const std::string& path,
                                   const FileHead& head);

/// All bytes of a file; none of one that cannot be read.
std::string file_bytes(const std::string& path);
/// The head of a file; empty of what is no file, which reading might wait for.
FileHead read_head(const std::string& path);

/// Whether `path` ends in an extension of mesh_formats(), in any case. Does not look at the file.
bool is_mesh_name(const std::string& path);

/// Can what is read of a file depend on MeshParams::frame? By its content; of a file that cannot be read, by its name.
bool has_time(const std::string& path);

/// Is it an image of heights, which MeshParams::terrain is for? As has_time().
bool has_heights(const std::string& path);

/// As read_mesh(), for a table of formats.
bool import_mesh(Mesh& dst, const std::string& path, const MeshParams& params, std::string& error,
                 const BeforeOpen& before_open = {}, const std::vector<MeshFormat>& formats = mesh_formats(),
                 bool keeps_instances = false);

} // namespace vmlight
