#include "pbs/solver/constraint_set.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

#include <cmath>

namespace pbs {

double share_removed(double k, const PbsOptions& options)
{
    if (options.stiffness_form == StiffnessForm::per_iteration || options.iterations == 0) return k;
    return 1.0 - std::pow(1.0 - k, 1.0 / options.iterations);
}

double stiffness_at_length(double k, double l0_m, double length_m)
{
    if (length_m == 0.0 || k == 0.0) return k;
    const double ratio = l0_m / length_m;
    return k / (k + (1.0 - k) * ratio * ratio);
}

namespace {

template <typename Number>
void require(bool holds, const char* field, Number value, const char* rule)
{
    if (!holds) throw InputError("pbs", 0, field, std::to_string(value), rule);
}

void check_stiffness(const char* field, double k)
{
    require(k >= 0.0 && k <= 1.0, field, k, "expected 0 <= k <= 1");
}

void check_volume_of(const PbsOptions& options)
{
    require(options.region_tets >= 1, "region_tets", options.region_tets, "expected 1 or more");
    if (options.volume_of == VolumeOf::tets) return;
    const char* owners = options.volume_of == VolumeOf::regions ? "regions" : "tets_and_regions";
    if (options.sleep)
        throw InputError("pbs", 0, "volume_of", owners, "expected tets with sleep = true: regions do not sleep");
    if (options.volume_form != VolumeForm::derived)
        throw InputError("pbs", 0, "volume_of", owners, "expected tets with a volume_form other than derived");
}

void check_mesh(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                const std::vector<bool>& held)
{
    const auto size_error = [&](const char* field, auto size) {
        throw InputError("pbs", 0, field, std::to_string(size) + " entries",
                         "expected one per vertex, " + std::to_string(mesh.rest.rows()));
    };
    if (bind_distance.size() != mesh.rest.rows()) size_error("bind_distance", bind_distance.size());
    if (!jiggle_zone.empty() && Eigen::Index(jiggle_zone.size()) != mesh.rest.rows())
        size_error("jiggle_zone", jiggle_zone.size());
    if (!held.empty() && Eigen::Index(held.size()) != mesh.rest.rows()) size_error("held", held.size());
    if (mesh.tets.size() && mesh.rest.rows() == 0)
        throw InputError("mesh", 0, "points", "0", "expected at least one point");
    if (mesh.tets.size() && (mesh.tets.minCoeff() < 0 || mesh.tets.maxCoeff() >= mesh.rest.rows()))
        throw InputError("mesh", 0, "tets", "", expected_whole("vertex indices", 0, mesh.rest.rows() - 1));
    positive_volumes(mesh.rest, mesh.tets);
}

void check_held(const std::vector<bool>& held, const std::vector<bool>& jiggle_zone, const PbsOptions& options)
{
    for (std::size_t i = 0; i < held.size(); ++i) {
        if (!held[i]) continue;
        const auto refuse = [i](const char* rule) {
            throw InputError("pbs", 0, "held", "vertex " + std::to_string(i), rule);
        };
        if (options.jiggle && !jiggle_zone.empty() && jiggle_zone[i])
            refuse("expected a vertex outside the jiggling zone");
        if (options.lbs_entry == LbsEntry::increment)
            refuse("expected none with lbs_entry increment: all are integrated");
        if (options.volume_form != VolumeForm::derived)
            refuse("expected none with a printed volume_form: all masses are one");
    }
}

template <typename Scalar>
std::vector<StretchConstraint<Scalar>> stretch_constraints(const TetMesh& mesh, const std::vector<bool>& jiggle_zone,
                                                           const PbsOptions& options)
{
    std::vector<StretchConstraint<Scalar>> constraints;
    const Edges edges = edges_of(mesh.tets);
    for (Eigen::Index e = 0; e < edges.rows(); ++e) {
        const int first = edges(e, 0), second = edges(e, 1);
        const bool jiggles = options.jiggle && !jiggle_zone.empty() && jiggle_zone[first] && jiggle_zone[second];
        const double k = jiggles ? options.jiggle->k_stretch : options.k_stretch;
        // Eq. 10
        const double rest_length =
            value<double>(StretchConstraint<double>{}, mesh.rest.row(first), mesh.rest.row(second));
        const double k_edge = stiffness_at_length(k, rest_length, options.k_stretch_length_m);
        if (k > 0.0)
            constraints.push_back({{first, second}, Scalar(rest_length), Scalar(share_removed(k_edge, options))});
    }
    return constraints;
}

template <typename Scalar>
std::vector<VolumeConstraint<Scalar>> volume_constraints(const TetMesh& mesh, double k)
{
    std::vector<VolumeConstraint<Scalar>> constraints;
    for (Eigen::Index t = 0; t < mesh.tets.rows() && k > 0.0; ++t) {
        const std::array<int, 4> vertex = {mesh.tets(t, 0), mesh.tets(t, 1), mesh.tets(t, 2), mesh.tets(t, 3)};
        const double rest_volume = value<double>(VolumeConstraint<double>{}, mesh.rest.row(vertex[0]),
                                                 mesh.rest.row(vertex[1]), mesh.rest.row(vertex[2]),
                                                 mesh.rest.row(vertex[3]));  // Eq. 11
        constraints.push_back({vertex, Scalar(rest_volume), Scalar(k)});
    }
    return constraints;
}

template <typename Scalar>
std::vector<RegionVolumeConstraint<Scalar>> region_constraints(const TetMesh& mesh, int region_tets, double k)
{
    std::vector<RegionVolumeConstraint<Scalar>> constraints;
    if (!(k > 0.0)) return constraints;
    const std::vector<int> region = tet_regions(mesh.tets, region_tets);
    for (const Triangles& surface : region_surfaces(mesh.tets, region))
        constraints.push_back(make_region_volume_constraint<Scalar>(surface, mesh.rest, k));
    return constraints;
}

template <typename Scalar>
std::vector<BindConstraint<Scalar>> bind_constraints(const Eigen::VectorXd& distance,
                                                     const std::vector<bool>& jiggle_zone, const PbsOptions& options)
{
    std::vector<BindConstraint<Scalar>> constraints;
    for (int i = 0; i < distance.size(); ++i) {
        const bool jiggles = options.jiggle && !jiggle_zone.empty() && jiggle_zone[i];
        const double k = jiggles ? options.jiggle->k_bind.value_or(options.k_bind) : options.k_bind;
        const bool unbound = distance(i) == 0.0 && options.bind_on_bone == BindOnBone::unbound;
        const double rest_distance = options.bind_to == BindTo::blended_position ? 0.0 : distance(i);
        if (k > 0.0 && !unbound) constraints.push_back({i, Scalar(rest_distance), Scalar(share_removed(k, options))});
    }
    return constraints;
}

template <typename Scalar>
std::vector<Scalar> inverse_masses(const TetMesh& mesh, Masses masses, const std::vector<bool>& held)
{
    std::vector<Scalar> inverse_mass(mesh.rest.rows(), Scalar(1));
    if (masses == Masses::lumped) {
        const Eigen::VectorXd lumped = lumped_volumes(mesh.rest, mesh.tets);
        const double mean = lumped.mean();
        for (Eigen::Index i = 0; i < lumped.size(); ++i)
            if (lumped(i) > 0.0) inverse_mass[i] = Scalar(mean / lumped(i));
    }
    for (std::size_t i = 0; i < held.size(); ++i)
        if (held[i]) inverse_mass[i] = Scalar(0);
    return inverse_mass;
}

}  // namespace

void check_options(const PbsOptions& options)
{
    require(options.iterations >= 0, "iterations", options.iterations, "expected 0 or more");
    check_stiffness("k_stretch", options.k_stretch);
    check_stiffness("k_volume", options.k_volume);
    check_stiffness("k_bind", options.k_bind);
    if (options.jiggle) check_stiffness("jiggle.k_stretch", options.jiggle->k_stretch);
    if (options.jiggle && options.jiggle->k_bind) check_stiffness("jiggle.k_bind", *options.jiggle->k_bind);
    require(options.stop_residual >= 0.0, "stop_residual", options.stop_residual, "expected 0 or more");
    require(options.threads >= 1, "threads", options.threads, "expected 1 or more");
    require(options.sleep_tolerance >= 0.0, "sleep_tolerance", options.sleep_tolerance, "expected 0 or more");
    require(options.k_stretch_length_m >= 0.0 && std::isfinite(options.k_stretch_length_m), "k_stretch_length_m",
            options.k_stretch_length_m, "expected 0 or more, finite");
    check_volume_of(options);
}

template <typename Scalar>
ConstraintSet<Scalar> make_constraint_set(const TetMesh& mesh, const Eigen::VectorXd& bind_distance,
                                          const std::vector<bool>& jiggle_zone, const PbsOptions& options,
                                          const std::vector<bool>& held)
{
    check_options(options);
    check_mesh(mesh, bind_distance, jiggle_zone, held);
    check_held(held, jiggle_zone, options);
    const double share = share_removed(options.k_volume, options);
    const bool of_tets = options.volume_of != VolumeOf::regions, of_regions = options.volume_of != VolumeOf::tets;
    return {bind_constraints<Scalar>(bind_distance, jiggle_zone, options),
            stretch_constraints<Scalar>(mesh, jiggle_zone, options),
            volume_constraints<Scalar>(mesh, of_tets ? share : 0.0), inverse_masses<Scalar>(mesh, options.masses, held),
            of_regions ? region_constraints<Scalar>(mesh, options.region_tets, share)
                       : std::vector<RegionVolumeConstraint<Scalar>>{}};
}

template ConstraintSet<float> make_constraint_set(const TetMesh&, const Eigen::VectorXd&, const std::vector<bool>&,
                                                  const PbsOptions&, const std::vector<bool>&);
template ConstraintSet<double> make_constraint_set(const TetMesh&, const Eigen::VectorXd&, const std::vector<bool>&,
                                                   const PbsOptions&, const std::vector<bool>&);

}  // namespace pbs
