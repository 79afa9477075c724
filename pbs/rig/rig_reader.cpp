#include "pbs/rig/rig_reader.hpp"

#include "pbs/geometry/content_format.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/isolated_reader.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"
#include "pbs/rig/assimp_rig.hpp"
#include "pbs/rig/gltf_rig.hpp"
#include "pbs/rig/rig_bytes.hpp"

#include <algorithm>

namespace pbs {
namespace {

enum class RigFormat { none, gltf, fbx, collada };

RigFormat format_of(const std::string& path)
{
    const std::string extension = content_extension(path);
    if (extension == ".glb" || extension == ".gltf") return RigFormat::gltf;
    if (extension == ".fbx") return RigFormat::fbx;
    return extension == ".dae" || extension == ".zae" ? RigFormat::collada : RigFormat::none;
}

// With or without a mesh.
Rig read_any_rig(const std::string& path)
{
    require_readable(path, most_mesh_bytes);
    const RigFormat format = format_of(path);
    if (format == RigFormat::none)
        throw InputError(path, 0, "", "", "no rig: expected glTF 2.0 (.glb, .gltf), FBX (.fbx) or COLLADA (.dae, .zae)");
    const auto read = [&](const std::string& file) {
        return packed(format == RigFormat::gltf ? read_gltf_rig(file) : read_assimp_rig(file));
    };
    return unpacked_rig(read_isolated(path, read), path);
}

}  // namespace

bool is_rig_file(const std::string& path)
{
    return format_of(path) != RigFormat::none;
}

Rig read_rig(const std::string& path)
{
    Rig rig = read_any_rig(path);
    if (rig.meshes.empty()) throw InputError(path, 0, "meshes", "0", "expected a mesh with triangles");
    return rig;
}

bool rig_has_skin(const std::string& path)
{
    const Rig rig = read_any_rig(path);
    return std::any_of(rig.meshes.begin(), rig.meshes.end(), [](const RigMesh& mesh) { return !mesh.joints.empty(); });
}

}  // namespace pbs
