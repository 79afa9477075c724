#include "experiments/studies/bench/plain_blend.hpp"

#include "pbs/skinning/blend.hpp"

#include <map>

namespace experiments {
namespace {

using Blend = decltype(pbs::linear_blend_skinning);

const std::map<std::string, Blend*> blends = {{"lbs", &pbs::linear_blend_skinning}, {"dqs", &pbs::dual_quaternion_skinning}};

class PlainBlend : public Deformer {
public:
    explicit PlainBlend(Blend* blend) : blend_(blend) {}

    void reset(const pbs::Character& character) override
    {
        character_ = &character;
        positions_ = character.mesh.rest;
    }
    pbs::StepSummary advance(const pbs::Pose& pose, double /*dt_s*/) override
    {
        blend_(character_->mesh.rest, character_->weights, pose, positions_);
        return {};
    }
    const pbs::Positions& positions() const override { return positions_; }

private:
    Blend* blend_;
    const pbs::Character* character_ = nullptr;
    pbs::Positions positions_;
};

}  // namespace

bool is_blend(const std::string& kind)
{
    return blends.contains(kind);
}

std::unique_ptr<Deformer> make_plain_blend(const std::string& kind)
{
    return std::make_unique<PlainBlend>(blends.at(kind));
}

}  // namespace experiments
