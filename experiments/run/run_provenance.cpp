#include "experiments/run/run_provenance.hpp"

#include "experiments/process/blas_kernels.hpp"

#include <fmt/chrono.h>
#include <nlohmann/json.hpp>

#include <ctime>

namespace experiments {

analysis::Provenance run_provenance(int threads)
{
    analysis::Provenance provenance = analysis::collect_provenance(threads);
    provenance.libraries["CGAL"] = PBS_CGAL_VERSION;
    provenance.libraries["VTK"] = PBS_VTK_VERSION;
    provenance.libraries["assimp"] = PBS_ASSIMP_VERSION;
    provenance.blas = blas_in_use();
    return provenance;
}

nlohmann::json run_end(double wall_s)
{
    return {{"ended_utc", fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr)))}, {"wall_s", wall_s}};
}

}  // namespace experiments
