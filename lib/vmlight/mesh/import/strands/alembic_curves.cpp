// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/mesh/import/alembic.h>
#include <vmlight/mesh/import/alembic/curves.h>
#include <vmlight/mesh/import/alembic/error.h>
#include <vmlight/mesh/import/alembic/hierarchy.h>
#include <vmlight/mesh/import/alembic/poly_mesh.h>
#include <vmlight/mesh/import/strands/strand_format.h>

#include <cmath>

namespace vmlight {
namespace {

using Imath::M44d;
using Imath::V3d;

int no_node(const std::string&, int)
{
    return -1;
}

// How much a transform enlarges, in the mean of all directions.
double scale_of(const M44d& matrix)
{
    return std::cbrt(std::abs(matrix.determinant()));
}

void append_curves(Strands& dst, bool& have_widths, const alembic::Curves& curves, const M44d& to_object)
{
    const double points = double(dst.points.size()) + double(curves.points.size());
    if (points > UINT32_MAX
        || double(curves.points.size()) * (sizeof(V3d) + sizeof(double)) > double(available_memory()))
        throw alembic::Error(format("its curves have {:.6g} points, more than there is memory for", points));
    const auto first = uint32_t(dst.points.size());
    for (const V3d& point : curves.points)
        dst.points.push_back(point * to_object);
    for (const double width : curves.widths)
        dst.radii.push_back(width / 2 * scale_of(to_object));
    have_widths = have_widths && (curves.points.empty() || !curves.widths.empty());
    for (const uint32_t end : curves.ends)
        dst.ends.push_back(first + end);
}

} // namespace

bool has_alembic_curves_alone(const StrandRequest& request)
{
    std::string error = alembic_fault(request.head);
    bool has_curves = false, has_others = false;
    const auto look = [&](const alembic::Object& object, const std::string&, const alembic::Place&) {
        const auto& header = object.reader->getHeader();
        has_curves = has_curves || alembic::is_curves(header);
        has_others = alembic::is_poly_mesh(header) || alembic::is_subdivision_surface(header);
        return !has_others;
    };
    return error.empty()
        && alembic::without_errors(
               error, [&] { alembic::Hierarchy(request.path, request.params, M44d()).visit(no_node, look); })
        && has_curves && !has_others;
}

bool read_alembic_curves(Strands& dst, const StrandRequest& request, std::string& error)
{
    error = alembic_fault(request.head);
    bool have_widths = true;
    return error.empty() && alembic::without_errors(error, [&] {
               alembic::Hierarchy hierarchy(request.path, request.params, M44d());
               hierarchy.visit(
                   no_node, [&](const alembic::Object& object, const std::string&, const alembic::Place& place) {
                       if (!place.is_visible || !alembic::is_curves(object.reader->getHeader()))
                           return true;
                       try {
                           append_curves(dst, have_widths, read_curves(*object.reader, hierarchy.moment()),
                                         place.to_object);
                       } catch (const alembic::Error& reason) {
                           throw alembic::Error(format("\"{}\": {}", object.reader->getFullName(), reason.what()));
                       }
                       return true;
                   });
               if (!have_widths)
                   dst.radii.clear();
               if (dst.ends.empty())
                   throw alembic::Error("no strands: it shows no curves");
           });
}

} // namespace vmlight
