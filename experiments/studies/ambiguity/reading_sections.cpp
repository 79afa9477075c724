#include "experiments/studies/ambiguity/reading_values.hpp"
#include "experiments/studies/artefacts/artefact_values.hpp"

namespace experiments {
namespace {

void add_samples(std::vector<ArtefactSample>& samples, const ArtefactBody& body, const std::string& group, std::size_t pose,
                 const pbs::Positions& positions, int element_order)
{
    for (std::size_t joint = 0; joint < body.joints.size(); ++joint) {
        const JointProfile profile = body.sections[joint].measure(positions, body.posed.pose(pose));
        samples.push_back({group, pose, joint, extremes_of(profile), element_order});
    }
}

std::vector<ArtefactSample> reference_samples(const ArtefactCase& of, const ArtefactBody& body)
{
    std::vector<ArtefactSample> samples;
    if (of.claim != ArtefactCase::Claim::bulge) return samples;  // C04 does without it
    const Shapes shapes = body.posed.shapes(spec_of(of.scene, of.scene.reference));
    for (std::size_t pose = 0; pose < shapes.size(); ++pose)
        if (shapes[pose].finished) add_samples(samples, body, "reference", pose, shapes[pose].positions, 1);
    return samples;
}

}  // namespace

std::vector<ReadingValues> values_of_sections(const ArtefactCase& of, const std::vector<Reading>& readings)
{
    const ArtefactBody body(of);
    const std::vector<ArtefactSample> reference = reference_samples(of, body);
    std::vector<ReadingValues> all;
    for (const Reading& reading : readings) {
        const ReadMotion moved = move(body.posed.character(), of.scene, reading);
        std::vector<ArtefactSample> samples = reference;
        for (std::size_t pose = 0; pose < of.poses.size(); ++pose) {
            const pbs::Positions& shape = moved.shapes.at(static_cast<std::size_t>(of.poses[pose].frame));
            if (shape.allFinite()) add_samples(samples, body, "pbs", pose, shape, 0);
        }
        const bool bulge = of.claim == ArtefactCase::Claim::bulge;
        all.push_back({judged(bulge ? bulge_values(of, body, samples) : candy_wrapper_values(of, body, samples)), !moved.finite});
    }
    return all;
}

}  // namespace experiments
