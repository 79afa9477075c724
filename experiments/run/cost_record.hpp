// The cost of a run: seconds of each of its parts, peak memory, loaded shared objects. Every run.json has it under
// `cost`.
//   CostRecord cost;
//   const pbs::Character character = cost.time("character", [&] { return pbs::make_character(source); });
//   run["cost"] = cost.json();
#pragma once

#include "experiments/process/machine.hpp"
#include "pbs/geometry/cost.hpp"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <string>

namespace experiments {

class CostRecord {
public:
    // Does the work and adds its time to that of the part.
    template <typename Work>
    auto time(const std::string& part, const Work& work)
    {
        const Part timed(seconds_[part], cpu_seconds_[part]);
        return work();
    }
    // The same, and adds the time to that of one deformer too, by its label.
    template <typename Work>
    auto time(const std::string& part, const std::string& label, const Work& work)
    {
        const Part of_deformer(deformers_[label][part], cpu_deformers_[label][part]);
        return time(part, work);
    }

    double seconds(const std::string& part) const;  // 0 for a part that was not timed

    // seconds: by part, `total` since construction, `deformers` by label and part. cpu_seconds: the same in processor
    // time of all threads, which other work on the machine stretches less. peak_memory_mb (10^6 bytes) and
    // shared_objects are those of the process.
    nlohmann::json json() const;

private:
    class Part {
    public:
        Part(double& seconds, double& cpu_seconds) : seconds_(seconds), cpu_seconds_(cpu_seconds) {}
        ~Part()
        {
            seconds_ += stopwatch_.seconds();
            cpu_seconds_ += process_cpu_s() - cpu_start_s_;
        }
        Part(const Part&) = delete;
        Part& operator=(const Part&) = delete;

    private:
        double &seconds_, &cpu_seconds_;
        pbs::Stopwatch stopwatch_;
        double cpu_start_s_ = process_cpu_s();
    };

    pbs::Stopwatch stopwatch_;
    double cpu_start_s_ = process_cpu_s();
    std::map<std::string, double> seconds_, cpu_seconds_;
    std::map<std::string, std::map<std::string, double>> deformers_, cpu_deformers_;
};

}  // namespace experiments
