// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/alembic.h>

namespace vmlight {

bool read_alembic(MeshBuilder&, const ImportRequest& request, std::string& error)
{
    error = alembic_fault(request.head);
    if (error.empty())
        error = "an Alembic file, but this vmlight was built without Alembic: build it where the Alembic library is "
                "installed (Debian sid: libalembic-graphics-dev), or export the mesh as glTF, OBJ or PLY, a file for "
                "each frame";
    return false;
}

} // namespace vmlight
