// Poisson's ratio of the elastic body that the skeleton deforms as it deforms another body. With displacement data, free surfaces and no
// body force Young's modulus cancels, so nu is all there is to fit.
//   const ElasticPoses elastic(character, paths, fem_options, 7);
//   if (const auto fit = fit_poisson(character, elastic, positions_of_each_pose)) ...
#pragma once

#include "analysis/metrics/error_norms.hpp"
#include "analysis/statistics/minimise.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "pbs/character/character.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

inline constexpr double highest_poisson = 0.4999;

// `count` >= 2 ratios from 0 to highest_poisson, increasing, both ends included.
std::vector<double> poisson_nodes(int count);
// A ratio between the nodes i and i + 1, where the interpolant is farthest from what was solved.
double between(const std::vector<double>& nodes, int i);

// A pose's elastic solution as a function of Poisson's ratio: solved at a few ratios and interpolated between them, so that a fit costs no
// further solves. The interpolant is the polynomial in log10(1 - 2 nu) through Chebyshev's points: near 1/2 the solution is smooth in the
// logarithm of the distance to it, not in nu.
class PoissonFamily {
public:
    PoissonFamily(const std::vector<double>& poisson, std::vector<pbs::Positions> positions);  // one per ratio [m], #V x 3

    pbs::Positions at(double poisson) const;  // [m], #V x 3

private:
    std::vector<double> nodes_, weights_;  // in log10(1 - 2 nu); barycentric
    std::vector<pbs::Positions> positions_;
};

struct NamedPose {
    std::string name;  // twist 30
    pbs::Pose pose;
};

// The elastic solutions of the poses at several Poisson's ratios. A pose is reached from the one before it, so they go along one path.
class ElasticPoses {
public:
    ElasticPoses(const pbs::Character& character, const std::vector<std::vector<NamedPose>>& paths, const FemOptions& options, int ratios);

    struct Elastic {
        NamedPose pose;
        std::optional<PoissonFamily> family;   // none: fewer than four ratios converged
        double highest_poisson = 0.0;          // the last of the ratios before the first one that did not converge
        double interpolation_error_pct = 0.0;  // error_joint between the interpolant and a solve between two ratios, the larger of two
    };
    const std::vector<Elastic>& poses() const { return poses_; }
    const std::vector<bool>& prescribed() const { return prescribed_; }  // #V, or empty

private:
    void add_path(const pbs::Character& character, const std::vector<NamedPose>& path, const FemOptions& options,
                  const std::vector<double>& nodes);

    std::vector<Elastic> poses_;
    std::vector<bool> prescribed_;
};

struct PoissonFit {
    analysis::FittedParameter poisson;         // misfits: error_joint [%]; cases: the poses that have a family, in order
    std::vector<std::string> poses;            // their names
    double highest_poisson = 0.0;              // up to where all of them converged: the fit's upper bound
    std::vector<analysis::Evaluation> valley;  // misfit of all poses over a fine grid of nu
};

// positions: of the body to be fitted, one per pose of `elastic`, in that order [m], #V x 3. Nothing where no pose has a family.
std::optional<PoissonFit> fit_poisson(const pbs::Character& character, const ElasticPoses& elastic,
                                      const std::vector<pbs::Positions>& positions);

}  // namespace experiments
