#include "experiments/deformers/external/external_deformers.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/process/terminal.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

bool same(const pbs::Pose& a, const pbs::Pose& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Eigen::Isometry3d& one, const Eigen::Isometry3d& other) { return one.matrix() == other.matrix(); });
}

// How a program failed, with the last line that it printed: of a Python program, that is the exception.
std::string end_of(const ProgramRun& program)
{
    if (!program.started) return "cannot be started: " + program.last_words;
    const std::string last_line = program.last_words.substr(program.last_words.find_last_of('\n') + 1);
    const std::string end = program.status < 0 ? "ended by a signal" : fmt::format("ended with status {}", program.status);
    return end + ": expected status 0" + (last_line.empty() ? "" : "; its last line: " + last_line);
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

    nlohmann::json record() const override { return {{"own_times", done_.seconds.has_value()}}; }

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
        stop_if_interrupted();
        if (!program.succeeded()) refuse_external(options_, end_of(program));
        try {
            done_ = read_exchange(folder.path().string(), character_->mesh.rest.rows(), foreseen_.size());
        } catch (const pbs::InputError& error) {
            refuse_external(options_, error.what());
        }
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
