// SPDX-License-Identifier: Apache-2.0
// Any bytes as a glTF or a GLB, payloads of Draco and meshoptimizer included: refused in one line, or a whole mesh.
//   gltf_fuzz -max_total_time=60 -max_len=4096 NEW_CORPUS tests/fuzz/gltf_corpus tests/data/cases
#include "law.h"
#include "mesh_law.h"

#include <vmlight/mesh/import/importer.h>

#include <algorithm>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

using namespace vmlight;
using namespace vmlight::fuzz;

namespace {

/// A file in memory, in a folder where nothing lies that a URI could name.
class MemoryFile
{
public:
    MemoryFile(const uint8_t* data, size_t size)
        : m_file(memfd_create("mesh", MFD_CLOEXEC))
    {
        require(m_file >= 0 && write(m_file, data, size) == ssize_t(size), "there is room for a file", "");
    }
    ~MemoryFile() { close(m_file); }
    std::string path() const { return "/proc/self/fd/" + std::to_string(m_file); }

private:
    int m_file;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    static const std::vector<MeshFormat> gltf_alone = [] {
        std::vector<MeshFormat> formats = mesh_formats();
        formats.erase(std::remove_if(formats.begin(), formats.end(),
                                     [](const MeshFormat& f) { return std::string(f.name) != "glTF 2.0"; }),
                      formats.end());
        return formats;
    }();
    const MemoryFile file(data, size);
    for (const int uv_set : { 0, 1 }) {
        MeshParams params;
        params.uv_set = uv_set;
        Mesh mesh;
        std::string error;
        if (import_mesh(mesh, file.path(), params, error, {}, gltf_alone))
            require_whole(mesh);
        else
            require_reason(error);
    }
    return 0;
}
