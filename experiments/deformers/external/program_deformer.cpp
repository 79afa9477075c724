#include "experiments/deformers/external/external_deformers.hpp"

#include "analysis/records/scratch_folder.hpp"
#include "experiments/deformers/external/exchange_folder.hpp"
#include "experiments/process/program_run.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/stopwatch.hpp"

#include <filesystem>

namespace experiments {
namespace {

bool same(const pbs::Pose& a, const pbs::Pose& b)
{
    for (std::size_t bone = 0; bone < a.size(); ++bone)
        if (a[bone].matrix() != b[bone].matrix()) return false;
    return a.size() == b.size();
}

class ProgramDeformer : public Deformer {
public:
    explicit ProgramDeformer(const ExternalOptions& options) : options_(options) {}

    void reset(const pbs::Character& character) override
    {
        character_ = &character;
        positions_ = character.mesh.rest;
        foreseen_.clear();
        done_ = {};
        next_ = 0;
    }

    void foresee(const std::vector<pbs::Pose>& poses) override
    {
        foreseen_ = poses;
        done_ = {};
        next_ = 0;
    }

    bool has_memory() const override { return options_.has_memory; }
    const pbs::Positions& positions() const override { return positions_; }

    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override
    {
        const bool is_next = next_ < foreseen_.size() && same(foreseen_[next_], pose);
        if (!is_next) {
            foreseen_ = {pose};
            next_ = 0;
        }
        if (next_ == 0) run(dt_s);
        pbs::StepSummary summary;
        positions_ = done_.positions[next_];
        summary.seconds = done_.seconds ? (*done_.seconds)[next_] : wall_s_ / static_cast<double>(foreseen_.size());
        if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
        ++next_;
        return summary;
    }

    nlohmann::json record() const override { return {{"command", options_.command}, {"own_times", done_.seconds.has_value()}}; }

private:
    void run(double dt_s)
    {
        const analysis::ScratchFolder folder;
        write_exchange(folder.path().string(), *character_, foreseen_, dt_s);
        std::vector<std::string> words = options_.command;
        words.push_back(folder.path().string());
        const pbs::Stopwatch stopwatch;
        const ProgramRun program = run_program(words, folder.path().string());
        wall_s_ = stopwatch.seconds();
        if (!program.started) throw pbs::InputError("", 0, "external.command", words.front(), "cannot be started");
        if (!program.succeeded())
            throw pbs::InputError("", 0, "external.command", words.front(),
                                  "ended with status " + std::to_string(program.status) + ": " + program.last_words);
        done_ = read_exchange(folder.path().string(), character_->mesh.rest.rows(), foreseen_.size());
    }

    ExternalOptions options_;
    const pbs::Character* character_ = nullptr;
    std::vector<pbs::Pose> foreseen_;
    ExchangedPositions done_;  // of the foreseen poses
    std::size_t next_ = 0;     // of them
    double wall_s_ = 0.0;      // of the program for all of them
    pbs::Positions positions_;
};

}  // namespace

std::unique_ptr<Deformer> make_program_deformer(const ExternalOptions& options)
{
    return std::make_unique<ProgramDeformer>(options);
}

}  // namespace experiments
