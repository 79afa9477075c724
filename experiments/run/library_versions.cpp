#include "experiments/run/library_versions.hpp"

namespace experiments {

std::map<std::string, std::string> library_versions()
{
    return {{"CGAL", PBS_CGAL_VERSION}, {"VTK", PBS_VTK_VERSION}, {"assimp", PBS_ASSIMP_VERSION}};
}

}  // namespace experiments
