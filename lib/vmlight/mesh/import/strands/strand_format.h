// SPDX-License-Identifier: Apache-2.0
/// The seam between files of strands and what reads them. A format is one entry of strand_formats() and a file of its
/// own.
#pragma once

#include <vmlight/mesh/import/importer.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/strands.h>

#include <Imath/ImathVec.h>

#include <string>
#include <vector>

namespace vmlight {

/// A file of strands to read, once its format is known.
struct StrandRequest
{
    std::string path;
    FileHead head;
    const MeshParams& params;
    /// Call it for each further file, before it is opened. May be empty.
    BeforeOpen before_open;
};

struct StrandFormat
{
    /// As messages name it, and its extensions, in lower case, separated by blanks.
    const char *name, *extensions;
    /// Is a file that starts like this certainly of this format? nullptr if content cannot tell.
    bool (*has_content)(const FileHead& head);
    /// Of formats of meshes too, where the user says what is wanted: whether a file has lines and no triangles. False
    /// if it cannot be read. nullptr if there are no meshes.
    bool (*has_lines_alone)(const StrandRequest& request);
    /// Such a file has a radius too: with lines alone it is one of strands, whether or not the user gives one.
    bool has_radius;
    /// Append the strands of a file, in its own axes.
    /// @returns false, with the reason in `error` (on one line, without the path), if it cannot be read
    bool (*read)(Strands& dst, const StrandRequest& request, std::string& error);
};

/// Every format that read_strands() reads.
const std::vector<StrandFormat>& strand_formats();

/// End a strand that consists of the points behind the last one's.
inline void end_strand(Strands& dst)
{
    dst.ends.push_back(uint32_t(dst.points.size()));
}

bool read_tfx(Strands& dst, const StrandRequest& request, std::string& error);
bool is_hair(const FileHead& head);
bool read_hair(Strands& dst, const StrandRequest& request, std::string& error);
bool has_obj_lines_alone(const StrandRequest& request);
bool read_obj_lines(Strands& dst, const StrandRequest& request, std::string& error);
bool has_gltf_lines_alone(const StrandRequest& request);
bool read_gltf_lines(Strands& dst, const StrandRequest& request, std::string& error);
bool has_alembic_curves_alone(const StrandRequest& request);
bool read_alembic_curves(Strands& dst, const StrandRequest& request, std::string& error);

} // namespace vmlight
