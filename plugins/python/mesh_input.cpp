// SPDX-License-Identifier: Apache-2.0
#include "mesh_input.h"

#include "work.h"

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/uv/unwrap.h>

#include <pybind11/numpy.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace vmlight::python {
namespace {

// Normals of this length, but for rounding, keep their bits.
constexpr float kUnitLength = 1e-6f;

using MeshPointer = std::shared_ptr<Mesh>;

// An array of `rows` x `columns` as the type of the library; any number of rows if that is -1.
template <class T>
py::array_t<T> table(const char* name, const py::object& value, py::ssize_t columns, py::ssize_t rows, char kind)
{
    const py::module_ numpy = py::module_::import("numpy");
    const py::array array = numpy.attr("asarray")(value);
    const char found = array.dtype().kind();
    if (kind == 'f' ? found != 'f' : found != 'i' && found != 'u')
        throw py::type_error(format("{}: must be an array of {}, not {}", name, kind == 'f' ? "floats" : "integers",
                                    py::cast<std::string>(py::str(array.dtype()))));
    if (array.ndim() != 2 || array.shape(1) != columns || (rows >= 0 && array.shape(0) != rows))
        throw py::value_error(format("{}: must have the shape ({}, {}), not {}", name,
                                     rows >= 0 ? std::to_string(rows) : "n", columns,
                                     py::cast<std::string>(py::str(array.attr("shape")))));
    return py::array_t<T>(numpy.attr("require")(array, py::dtype::of<T>(), "CA"));
}

template <class Vector, class T> void copy_rows(std::vector<Vector>& dst, const py::array_t<T>& rows)
{
    static_assert(sizeof(Vector) % sizeof(T) == 0);
    dst.resize(size_t(rows.shape(0)));
    if (!dst.empty())
        std::memcpy(static_cast<void*>(dst.data()), rows.data(), dst.size() * sizeof(Vector));
}

void fill_normals(Mesh& mesh, const py::object& normals, double crease_angle)
{
    if (normals.is_none()) {
        mesh.normals.assign(mesh.positions.size(), Imath::V3f(0));
        make_smooth_normals(mesh, crease_angle);
        mesh.normals_from = crease_angle == 0 ? "flat" : "smooth";
        return;
    }
    copy_rows(mesh.normals, table<float>("normals", normals, 3, py::ssize_t(mesh.positions.size()), 'f'));
    for (Imath::V3f& normal : mesh.normals) {
        const float length = normal.length();
        if (!(length > 0) || !std::isfinite(length))
            normal = Imath::V3f(0); // missing
        else if (std::abs(length - 1) > kUnitLength)
            normal /= length;
    }
    mesh.normals_from = "given";
    fill_missing_normals(mesh, crease_angle);
}

struct MeshArguments
{
    std::string name = "mesh";
    double crease_angle = 180;

    template <class Visit> void visit(Visit&& field)
    {
        field("name", name, Text {}, "What vmlight:mesh of its maps says");
        field("crease_angle", crease_angle, Range { 0, 180 },
              "Where normals are missing: edges sharper than this, in degrees, stay hard");
    }
};

// The operands positions, triangles, uvs and normals.
MeshPointer mesh_of_arrays(const std::vector<py::object>& operands, const MeshArguments& given)
{
    const py::object &positions = operands[0], &triangles = operands[1], &uvs = operands[2], &normals = operands[3];
    const auto mesh = std::make_shared<Mesh>();
    mesh->name = given.name;
    const auto points = table<double>("positions", positions, 3, -1, 'f');
    mesh->has_exact_positions = py::array(py::module_::import("numpy").attr("asarray")(positions)).itemsize() == 8;
    copy_rows(mesh->positions, points);
    const py::ssize_t count = points.shape(0);
    // As 64 bits first: an index that is negative or too large must not wrap to one that exists.
    const auto corners = table<int64_t>("triangles", triangles, 3, -1, 'i');
    for (const int64_t* corner = corners.data(); corner != corners.data() + corners.size(); ++corner)
        if (*corner < 0 || *corner >= count || *corner > std::numeric_limits<uint32_t>::max())
            throw py::value_error(format("triangles: triangle {} uses vertex {}, but there are {}",
                                         (corner - corners.data()) / 3, *corner, count));
    for (py::ssize_t i = 0; i < corners.shape(0); ++i)
        mesh->triangles.push_back(
            { uint32_t(corners.at(i, 0)), uint32_t(corners.at(i, 1)), uint32_t(corners.at(i, 2)) });
    if (!uvs.is_none())
        copy_rows(mesh->uvs, table<float>("uvs", uvs, 2, count, 'f'));
    // Before normals: they are means over triangles, whose corners must be points.
    mesh->normals.resize(mesh->positions.size());
    if (std::string error; !check_mesh(*mesh, error))
        throw py::value_error(error);
    fill_normals(*mesh, normals, given.crease_angle);
    return mesh;
}

template <class Vector, class T> py::array_t<T> rows_of(const std::vector<Vector>& rows)
{
    constexpr py::ssize_t columns = sizeof(Vector) / sizeof(T);
    py::array_t<T> array({ py::ssize_t(rows.size()), columns });
    if (!rows.empty())
        std::memcpy(array.mutable_data(), static_cast<const void*>(rows.data()), rows.size() * sizeof(Vector));
    return array;
}

struct UnwrapArguments
{
    Size resolution { 1024, 1024 };
    int margin = 16;

    template <class Visit> void visit(Visit&& field)
    {
        field("resolution", resolution, SizeRange { 32768, 1 }, "Size of the map that the atlas is for, in texels");
        field("margin", margin, Range { 0, 32768 }, "Texels between charts");
    }
};

const char* const kMesh
    = R"(A triangle mesh in memory, in object space: right-handed, y up, counter-clockwise seen from outside.

Arrays are copied. Vertices are split where normals are hard, so that a mesh may have more than it was made of.)";

} // namespace

std::vector<std::string> MeshInput::paths() const
{
    std::vector<std::string> all = occluder_paths;
    all.insert(all.begin(), mesh_path);
    return all;
}

Operand mesh_operand()
{
    return { "mesh", "StrPath | Mesh", "The mesh to bake: a file, or one in memory" };
}

Operand occluder_operand()
{
    return { "occluder", "StrPath | Mesh | Sequence[StrPath | Mesh]",
             "What occludes and is not baked; files if the mesh is a file, else in memory", "()" };
}

MeshInput mesh_input(py::handle mesh, py::handle occluder)
{
    MeshInput input;
    const bool is_file = is_path(mesh);
    if (is_file)
        input.mesh_path = path_text("mesh", mesh);
    else if (py::isinstance<Mesh>(mesh))
        input.mesh = py::cast<MeshPointer>(mesh);
    else
        throw py::type_error(format("mesh: must be a path or vmlight.Mesh, not {}", Py_TYPE(mesh.ptr())->tp_name));
    py::list others;
    if (is_path(occluder) || py::isinstance<Mesh>(occluder))
        others.append(occluder);
    else if (!occluder.is_none())
        others = py::list(py::reinterpret_borrow<py::object>(occluder));
    for (py::handle other : others) {
        if (!is_path(other) && !py::isinstance<Mesh>(other))
            throw py::type_error(
                format("occluder: must be paths or vmlight.Mesh, not {}", Py_TYPE(other.ptr())->tp_name));
        if (is_path(other) != is_file)
            throw py::type_error("mesh and occluder must both be files, or both in memory: Mesh.read() reads a file");
        if (is_file)
            input.occluder_paths.push_back(path_text("occluder", other));
        else
            input.occluders.push_back(py::cast<const Mesh&>(other));
    }
    return input;
}

void allow_only(const Call& call, const std::vector<std::string>& names, const char* what)
{
    for (const auto& [key, value] : call.keywords) {
        const std::string name = py::cast<std::string>(key);
        if (name != "threads" && name != "progress" && std::find(names.begin(), names.end(), name) == names.end())
            throw py::type_error(format("{}: only for {}", name, what));
    }
}

void define_mesh(py::module_& m)
{
    const char* const floats = "NDArray[Any] | Sequence[Sequence[float]]";
    const char* const optional = "NDArray[Any] | Sequence[Sequence[float]] | None";
    const Signature<MeshArguments> making(
        { "Mesh",
          FunctionKind::constructor,
          "A mesh of arrays, which are copied.",
          { { "positions", floats, "(n, 3); float64 keeps all bits of meshes far from the origin" },
            { "triangles", "NDArray[Any] | Sequence[Sequence[int]]", "(m, 3) integers: the vertices of each" },
            { "uvs", optional, "(n, 2); v = 0 is the bottom of the texture. What is baked needs them", "None" },
            { "normals", optional, "(n, 3), of any length; missing ones, and zeros, are smooth", "None" } },
          "",
          "" },
        {}, false);
    const Signature<MeshParams> reading(
        { "read",
          FunctionKind::static_method,
          "Read a mesh file, as makevismap does; opacity of materials is not read: bake the file for that.",
          { { "path", "StrPath", "OBJ, PLY, STL, glTF, Collada, FBX, Alembic, or terrain as an image" } },
          "Mesh",
          "" });
    const Signature<UnwrapArguments> unwrapping({ "unwrap",
                                                  FunctionKind::method,
                                                  "The same mesh with an atlas made for it in place of its UVs.",
                                                  {},
                                                  "Mesh",
                                                  "" });

    py::class_<Mesh, MeshPointer> mesh(m, "Mesh", kMesh);
    mesh.attr("__module__") = "vmlight";
    mesh.def(py::init([making](const py::args& args, const py::kwargs& kwargs) {
                 const auto [call, params] = making.read(args, kwargs);
                 return mesh_of_arrays(call.operands, params);
             }),
             docstring(making.function()).c_str())
        .def_property_readonly(
            "positions", [](const Mesh& self) { return rows_of<Imath::V3d, double>(self.positions); },
            "(n, 3) of float64: a copy.")
        .def_property_readonly(
            "normals", [](const Mesh& self) { return rows_of<Imath::V3f, float>(self.normals); },
            "(n, 3) of float32, of unit length: a copy.")
        .def_property_readonly(
            "uvs", [](const Mesh& self) { return rows_of<Imath::V2f, float>(self.uvs); },
            "(n, 2) of float32, or (0, 2) without UVs: a copy.")
        .def_property_readonly(
            "triangles", [](const Mesh& self) { return rows_of<std::array<uint32_t, 3>, uint32_t>(self.triangles); },
            "(m, 3) of uint32: a copy.")
        .def_property_readonly(
            "name", [](const Mesh& self) { return self.name; }, "File name without its folder, or as given.")
        .def("__repr__", [](const Mesh& self) {
            return format("<vmlight.Mesh \"{}\" {} triangles, {} vertices{}>", self.name, self.triangles.size(),
                          self.positions.size(), self.uvs.empty() ? ", without UVs" : "");
        });
    mesh.def_static(
        "read",
        [reading](const py::args& args, const py::kwargs& kwargs) {
            const auto [call, params] = reading.read(args, kwargs);
            const std::string path = path_text("path", call.operands[0]);
            const auto dst = std::make_shared<Mesh>();
            do_work(call.work, { path }, [&, &given = params](const MakeOptions& options, std::string& error) {
                if (!read_mesh(*dst, path, given, error))
                    return false;
                for (const std::string& warning : dst->warnings)
                    options.report_warning(warning);
                return true;
            });
            return dst;
        },
        docstring(reading.function()).c_str());
    mesh.def(
        "unwrap",
        [unwrapping](const Mesh& self, const py::args& args, const py::kwargs& kwargs) {
            const auto [call, params] = unwrapping.read(args, kwargs);
            const auto dst = std::make_shared<Mesh>(self);
            do_work(call.work, {}, [&, &given = params](const MakeOptions& options, std::string& error) {
                const UnwrapParams unwrap { given.resolution.width, given.resolution.height, given.margin,
                                            options.threads };
                return unwrap_mesh(*dst, unwrap, nullptr, error);
            });
            return dst;
        },
        docstring(unwrapping.function()).c_str());
    add_to_table("Mesh.__init__", making.function());
    add_to_table("Mesh.read", reading.function());
    add_to_table("Mesh.unwrap", unwrapping.function());
}

} // namespace vmlight::python
