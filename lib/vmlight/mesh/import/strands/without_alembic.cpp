// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/strands/strand_format.h>

namespace vmlight {

// Such files are meshes then, whose reader says what is missing.
bool has_alembic_curves_alone(const StrandRequest&)
{
    return false;
}

bool read_alembic_curves(Strands&, const StrandRequest&, std::string& error)
{
    error = "an Alembic file, but this vmlight was built without Alembic";
    return false;
}

} // namespace vmlight
