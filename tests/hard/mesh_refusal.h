// SPDX-License-Identifier: Apache-2.0
/// Mesh files that must be refused, for tests.
#pragma once

#include "temporary_folder.h"

#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/mesh/mesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace vmlight {

/// What is said of a file of these bytes, less the path; "" if the file is read.
inline std::string refusal(const TemporaryFolder& folder, const char* name, const std::string& bytes)
{
    const std::string path = folder.write(name, bytes);
    Mesh mesh;
    std::string error;
    if (read_mesh(mesh, path, {}, error))
        return "";
    EXPECT_EQ(error.find("\"" + path + "\": "), 0u) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_TRUE(mesh.triangles.empty());
    return error.substr(std::min(error.size(), path.size() + 4));
}

} // namespace vmlight
