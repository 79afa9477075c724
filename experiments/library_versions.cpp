#include "experiments/library_versions.hpp"

#include <Eigen/Core>
#include <fmt/core.h>
#include <gsl/gsl_version.h>
#include <nlohmann/json.hpp>
#include <toml++/toml.h>

namespace experiments {

// Of what is loaded in every run; the FEM module reports its own (deal.II, SuiteSparse, BLAS) in its record.
std::map<std::string, std::string> library_versions()
{
    return {
        {"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
        {"fmt", fmt::format("{}", FMT_VERSION)},
        {"GSL", gsl_version},
        {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
        {"toml++", fmt::format("{}.{}.{}", TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)},
        {"CGAL", PBS_CGAL_VERSION},
        {"VTK", PBS_VTK_VERSION},
        {"assimp", PBS_ASSIMP_VERSION}};
}

}  // namespace experiments
