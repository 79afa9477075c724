#include "experiments/process/own_process.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/process/failure.hpp"
#include "experiments/process/forked_process.hpp"
#include "experiments/process/interruption.hpp"
#include "pbs/geometry/input_error.hpp"

#include <nlohmann/json.hpp>

#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <string>

namespace experiments {
namespace {

ProcessEnd result_or_failure(const std::function<nlohmann::json()>& work)
{
    nlohmann::json end;
    try {
        end["result"] = work();
    } catch (...) {
        const Failure failure = caught_failure();
        end = {{"failure", failure.words}, {"status", failure.status}};
    }
    return {analysis::record_text(end), exit_finished};
}

nlohmann::json result_in(const std::string& text)
{
    const nlohmann::json end = nlohmann::json::parse(text, nullptr, false);
    if (end.is_object() && end.contains("result")) return end.at("result");
    if (!end.is_object()) throw std::runtime_error("a process ended without a result");
    if (end.value("status", exit_internal) == exit_input) throw pbs::InputError("", 0, "", "", end.value("failure", ""));
    throw std::runtime_error(end.value("failure", ""));
}

}  // namespace

nlohmann::json in_own_process(const std::function<nlohmann::json()>& work)
{
    ForkedProcess process = start_process([&] { return result_or_failure(work); });
    for (listen(process); process.from >= 0; listen(process)) {
        pass_on_interruption(process);
        wait_for_text({process.from});
    }
    int status = 0;
    while (waitpid(process.id, &status, 0) < 0 && errno == EINTR) {
    }
    stop_if_interrupted();
    if (WIFSIGNALED(status))
        throw pbs::InputError("", 0, "process", "signal " + std::to_string(WTERMSIG(status)), "expected to end by itself");
    return result_in(process.text);
}

}  // namespace experiments
