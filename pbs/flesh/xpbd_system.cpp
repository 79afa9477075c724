#include "pbs/flesh/xpbd_neo_hookean.hpp"

#include "pbs/geometry/input_error.hpp"

#include <string>

namespace pbs {

XpbdFlesh::XpbdFlesh(const TetMesh& mesh, const FleshEnergy& energy, const BoneHold& bones, const FleshMaterial& of_flesh, double time_step)
    : material(of_flesh), tets(neo_hookean_tets(mesh)), hold(bones), first_mode(tets.size() + 1, 0), w(energy.hold())
{
    if (!(time_step > 0.0)) throw InputError("flesh", 0, "time_step", std::to_string(time_step), "expected a value above 0");
    for (const HoldMode& mode : hold.modes()) ++first_mode[mode.tet + 1];
    for (std::size_t t = 0; t < tets.size(); ++t) first_mode[t + 1] += first_mode[t];
    for (const FleshTet& tet : energy.tets())
        for (int e = 0; e < 6; ++e)
            for (const int end : edges_of_tet[e]) w(tet.vertex[end]) += tet.w[e];
    for (double& stiffness : w) stiffness = stiffness > 0.0 ? time_step * time_step / stiffness : 1.0;
}

template <>
std::unique_ptr<XpbdSystem<float>> make_xpbd_system(const TetMesh& mesh, const XpbdFlesh& flesh, Arithmetic, int threads)
{
    return std::make_unique<PackedXpbd<float>>(mesh, flesh, threads);
}

template <>
std::unique_ptr<XpbdSystem<double>> make_xpbd_system(const TetMesh& mesh, const XpbdFlesh& flesh, Arithmetic arithmetic, int threads)
{
    if (arithmetic == Arithmetic::plain_f64) return std::make_unique<PlainXpbd>(flesh);
    return std::make_unique<PackedXpbd<double>>(mesh, flesh, threads);
}

}  // namespace pbs
