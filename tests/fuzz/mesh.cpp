// Any bytes as the output of the reader's process: a valid mesh in which every tet has a volume, or an InputError.
#include "pbs/geometry/guarded_reading.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_checks.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    try {
        const pbs::IndexedPoints read = pbs::unpacked_points(std::string(reinterpret_cast<const char*>(data), size), "mesh.vtu");
        if (read.cells.cols() != 4) return 0;
        const pbs::MeshReading reading = pbs::check_rest("mesh.vtu", {read.points, read.cells});
        if (!(pbs::tet_volumes(reading.mesh.rest, reading.mesh.tets).minCoeff() > 0.0)) std::abort();
    } catch (const pbs::InputError&) {
    }
    return 0;
}
