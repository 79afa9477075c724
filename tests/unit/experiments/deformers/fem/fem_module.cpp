// The module as the program uses it: loaded at run time, with errors thrown inside and caught outside. This test itself
// links no deal.II.
#include "experiments/deformers/fem/fem_options.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/system/module.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>
#include <link.h>

#include <cmath>
#include <memory>
#include <string_view>

namespace {

std::unique_ptr<experiments::Deformer> make_fem(const experiments::FemOptions& options)
{
    const auto make = pbs::load_module("pbskin_fem").function<decltype(pbskin_make_fem)>("pbskin_make_fem");
    return std::unique_ptr<experiments::Deformer>(make(options));
}

// The forearm turned by 0.1 about its axis.
pbs::Pose turned()
{
    pbs::Pose pose(2, Eigen::Isometry3d::Identity());
    pose[1].rotate(Eigen::AngleAxisd(0.1, pbs::Vec3::UnitX()));
    return pose;
}

// Whether a library of this name is loaded, in any version.
bool is_loaded(const char* library)
{
    const auto has_name = [](dl_phdr_info* info, std::size_t, void* name) {
        return static_cast<int>(std::string_view(info->dlpi_name).find(static_cast<const char*>(name)) !=
                                std::string_view::npos);
    };
    return dl_iterate_phdr(has_name, const_cast<char*>(library)) != 0;
}

TEST(FemModule, BringsDealIIOnlyWhenItIsAskedFor)
{
    EXPECT_FALSE(is_loaded("libdeal.ii.so"));
    const auto character = test_support::bar_character({24, 4, 4});
    const auto fem = make_fem({.element_order = 1});
    fem->reset(character);
    EXPECT_TRUE(is_loaded("libdeal.ii.so"));
    const pbs::Pose rest(2, Eigen::Isometry3d::Identity());
    EXPECT_EQ(fem->advance(rest, 0.01).outcome, pbs::Outcome::finished);
    EXPECT_EQ(fem->positions(), character.mesh.rest);
    EXPECT_NE(fem->record()["setup"]["blas"].get<std::string>().find("blas"), std::string::npos);
    EXPECT_THROW(make_fem({.element_order = 7})->reset(character), pbs::InputError)
        << "input errors are caught outside";
}

// At nu = 0.3 nothing locks, and the formulations differ by their discretisation errors: a few percent of the motion on
// these tets.
TEST(FemModule, EveryFormulationOfTheLinearModelKeepsItsFactor)
{
    const auto character = test_support::bar_character({24, 4, 4});
    pbs::Positions of_displacement;
    for (const auto formulation :
         {reference_fem::Formulation::displacement, reference_fem::Formulation::mean_dilatation,
          reference_fem::Formulation::taylor_hood}) {
        const auto fem = make_fem({.formulation = formulation, .poisson = 0.3});
        fem->reset(character);
        EXPECT_EQ(fem->advance(turned(), 0.01).outcome, pbs::Outcome::finished);
        EXPECT_TRUE(fem->record().contains("largest_residual")) << "only the linear deformer has it";
        if (formulation == reference_fem::Formulation::displacement) of_displacement = fem->positions();
        const pbs::Positions motion = of_displacement - character.mesh.rest;
        const double difference = (fem->positions() - of_displacement).norm() / motion.norm();
        EXPECT_LT(difference, 0.03);
        EXPECT_EQ(difference == 0.0, formulation == reference_fem::Formulation::displacement);
    }
}

}  // namespace
