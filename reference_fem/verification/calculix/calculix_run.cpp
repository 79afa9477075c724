#include "reference_fem/verification/calculix/calculix_run.hpp"

#include "analysis/records/record_files.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <regex>

namespace reference_fem {
namespace {

namespace fs = std::filesystem;

std::string text_of(const std::string& path)
{
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

// This process's environment with one thread for every library that CalculiX may be linked with.
std::vector<std::string> one_thread_environment()
{
    const std::vector<std::string> ours = {"OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1", "CCX_NPROC_EQUATION_SOLVER=1",
                                           "NUMBER_OF_CPUS=1"};
    std::vector<std::string> variables = ours;
    for (char** variable = environ; *variable; ++variable) {
        const std::string theirs = *variable;
        const std::string name = theirs.substr(0, theirs.find('=') + 1);
        if (std::none_of(ours.begin(), ours.end(), [&](const auto& one) { return one.starts_with(name); })) variables.push_back(theirs);
    }
    return variables;
}

bool wait_until_closed(int pipe, double seconds)
{
    const pbs::Stopwatch stopwatch;
    for (double left = seconds; left > 0.0; left = seconds - stopwatch.seconds()) {
        pollfd waiting{pipe, POLLIN, 0};
        if (poll(&waiting, 1, static_cast<int>(std::min(1000.0 * left + 1.0, 1e6))) > 0) return true;
    }
    return false;
}

// The child's surroundings: `folder` as its working directory, its output in a file there, and the writing end of a pipe that closes when
// it ends.
class SpawnActions {
public:
    SpawnActions(const std::string& folder, int pipe_end)
    {
        constexpr int free_descriptor = 3;
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
        posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "output.txt", O_WRONLY | O_CREAT | O_TRUNC, 0644);
        posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, pipe_end, free_descriptor);
    }
    ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
    SpawnActions(const SpawnActions&) = delete;
    SpawnActions& operator=(const SpawnActions&) = delete;

    const posix_spawn_file_actions_t* get() const { return &actions_; }

private:
    posix_spawn_file_actions_t actions_;
};

// `program OPTION deck` in a folder; finished where it ended by itself, in time and with exit status 0.
CalculixOutcome run_in(const std::string& folder, const std::string& program, const char* option, double limit_s, double& cpu_s)
{
    std::vector<std::string> variables = one_thread_environment();
    std::vector<char*> environment;
    for (std::string& variable : variables) environment.push_back(variable.data());
    environment.push_back(nullptr);
    const std::array<const char*, 4> arguments = {program.c_str(), option, "deck", nullptr};

    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return CalculixOutcome::not_started;
    pid_t child = 0;
    const SpawnActions actions(folder, ends[1]);
    const bool started =
        posix_spawn(&child, program.c_str(), actions.get(), nullptr, const_cast<char* const*>(arguments.data()), environment.data()) == 0;
    close(ends[1]);
    const bool in_time = started && wait_until_closed(ends[0], limit_s);
    close(ends[0]);
    if (!started) return CalculixOutcome::not_started;
    if (!in_time) kill(child, SIGKILL);
    int status = 0;
    rusage usage{};
    while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    const auto seconds = [](const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); };
    cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    if (!in_time) return CalculixOutcome::out_of_time;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? CalculixOutcome::finished : CalculixOutcome::refused;
}

constexpr const char* printed_name = "deck.dat";
constexpr const char* restart_name = "deck.rout";
constexpr double last_digit = 5.01e-7;  // half a unit of the 7th digit over the smallest mantissa 1.000000

// Fortran leaves out the E of an exponent of three digits: 1.234567-101.
std::optional<double> number(std::string text)
{
    const std::size_t sign = text.find_first_of("+-", 1);
    if (sign != std::string::npos && std::toupper(text[sign - 1]) != 'E') text.insert(sign, "E");
    double value = 0.0;
    const char* const begin = text.c_str() + (text.starts_with('+') ? 1 : 0);
    const char* const end = text.c_str() + text.size();
    const auto [stop, error] = std::from_chars(begin, end, value);
    const bool underflow = error == std::errc::result_out_of_range && std::abs(value) < 1.0;
    if ((error != std::errc() && !underflow) || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

class PrintedReader {
public:
    PrintedReader(const std::string& file, Eigen::Index nodes)
        : file_(file), seen_(nodes, false), displacements_(pbs::Positions::Zero(nodes, 3))
    {
    }

    pbs::Positions read(const std::string& text)
    {
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) {
            ++line_;
            if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
            line.find("displacements") != std::string::npos ? begin_block(line) : read_node(line);
        }
        if (blocks_ == 0) refuse("displacements", "", "expected a block of them");
        for (std::size_t n = 0; n < seen_.size(); ++n)
            if (!seen_[n]) refuse("node", std::to_string(n + 1), "expected a line of every node");
        return displacements_;
    }

private:
    [[noreturn]] void refuse(const std::string& field, const std::string& value, const std::string& rule) const
    {
        throw pbs::InputError(file_, line_, field, value, rule);
    }

    void begin_block(const std::string& line)
    {
        if (++blocks_ > 1) refuse("displacements", line, "expected one block of them");
        const std::string time = line.substr(line.find_last_of(' ') + 1);
        if (number(time) != 1.0) refuse("time", time, "expected 1, the end of the step");
    }

    void read_node(const std::string& line)
    {
        std::istringstream words(line);
        std::vector<std::string> fields;
        for (std::string word; words >> word;) fields.push_back(word);
        if (blocks_ == 0 || fields.size() != 4) refuse("line", line, "expected a node and three numbers below a header");
        const std::optional<double> node = number(fields[0]);
        if (!node || *node != std::floor(*node) || *node < 1.0 || *node > static_cast<double>(seen_.size()))
            refuse("node", fields[0], "expected 1 to " + std::to_string(seen_.size()));
        const auto n = static_cast<std::size_t>(*node) - 1;
        if (seen_[n]) refuse("node", fields[0], "expected one line per node");
        seen_[n] = true;
        for (int c = 0; c < 3; ++c) {
            const std::optional<double> component = number(fields[c + 1]);
            if (!component) refuse("displacement", fields[c + 1], "expected a finite number");
            displacements_(static_cast<Eigen::Index>(n), c) = *component;
        }
    }

    std::string file_;
    int line_ = 0, blocks_ = 0;
    std::vector<bool> seen_;
    pbs::Positions displacements_;
};

bool agrees(const pbs::Positions& record, const pbs::Positions& printed)
{
    constexpr double smallest_printed = 1e-99;
    return ((record - printed).array().abs() <= last_digit * printed.array().abs() + smallest_printed).all();
}

// A record of 1 + 3 numbers per node, the first one its temperature: of the nodes, then of the ends of springs.
std::optional<pbs::Positions> displacements_in(const std::string& restart, std::size_t begin, std::size_t length, Eigen::Index nodes)
{
    using Record = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;
    if (length % (sizeof(double) * 4) != 0 || length < sizeof(double) * 4 * nodes) return std::nullopt;
    Record record(nodes, 4);
    std::memcpy(record.data(), restart.data() + begin, sizeof(double) * record.size());
    return pbs::Positions(record.rightCols<3>());
}

// gfortran's unformatted records: length in 4 bytes, data, length again. A negative length (a record of 2 GiB in pieces) is not followed.
std::optional<pbs::Positions> find_in_restart(const std::string& restart, const pbs::Positions& printed)
{
    const auto length_at = [&](std::size_t at) {
        std::int32_t length = 0;
        if (at + sizeof length > restart.size()) throw pbs::InputError(restart_name, 0, "", "", "cut short");
        std::memcpy(&length, restart.data() + at, sizeof length);
        return length;
    };
    std::optional<pbs::Positions> displacements;
    for (std::size_t at = 0; at < restart.size();) {
        const std::int32_t length = length_at(at);
        if (length < 0) return std::nullopt;
        const std::size_t begin = at + sizeof length;
        if (length_at(begin + length) != length) throw pbs::InputError(restart_name, 0, "record", std::to_string(length), "damaged");
        const auto candidate = displacements_in(restart, begin, length, printed.rows());
        if (!displacements && candidate && agrees(*candidate, printed)) displacements = candidate;
        at = begin + length + sizeof length;
    }
    return displacements;
}

}  // namespace

const char* name_of(CalculixOutcome outcome)
{
    constexpr std::array<const char*, 4> names = {"finished", "refused", "out of time", "not started"};
    return names[static_cast<std::size_t>(outcome)];
}

std::string last_words(const std::string& output)
{
    constexpr std::size_t most = 400;
    const std::size_t end = output.find_last_not_of(" \t\r\n") + 1;
    return output.substr(end > most ? end - most : 0, std::min(end, most));
}

std::optional<std::string> calculix_on_path()
{
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const fs::path program = fs::absolute(fs::path(folder.empty() ? "." : folder) / "ccx");
        std::error_code ignored;
        if (fs::is_regular_file(program, ignored) && access(program.c_str(), X_OK) == 0) return program.string();
    }
    return std::nullopt;
}

std::string calculix_version(const std::string& program)
{
    const analysis::ScratchFolder folder;
    double cpu_s = 0.0;
    run_in(folder.path(), program, "-v", 10.0, cpu_s);
    const std::string output = text_of(folder / "output.txt");
    std::smatch match;
    return std::regex_search(output, match, std::regex(R"(Version\s+([\w.]+))")) ? "CalculiX " + match[1].str() : "unknown version";
}

CalculixRun run_calculix(const std::string& program, const std::function<void(std::ostream&)>& write_deck, const CalculixLimits& limits)
{
    const analysis::ScratchFolder folder;
    {
        std::ofstream deck(folder / "deck.inp");
        write_deck(deck);
        if (!deck.flush()) throw pbs::InputError(folder / "deck.inp", 0, "", "", "cannot be written: is there space for CalculiX's deck?");
    }
    CalculixRun run;
    const pbs::Stopwatch stopwatch;
    run.outcome = run_in(folder.path(), program, "-i", limits.seconds, run.cpu_s);
    run.wall_s = stopwatch.seconds();
    run.output = text_of(folder / "output.txt");
    run.printed = text_of(folder / "deck.dat");
    run.restart = text_of(folder / "deck.rout");
    if (run.outcome == CalculixOutcome::finished && run.output.find("*ERROR") != std::string::npos) run.outcome = CalculixOutcome::refused;
    return run;
}

pbs::Positions read_printed_displacements(const std::string& text, const std::string& file, Eigen::Index nodes)
{
    return PrintedReader(file, nodes).read(text);
}

CalculixDisplacements read_displacements(const std::string& printed, const std::string& restart, Eigen::Index nodes)
{
    CalculixDisplacements result;
    result.displacements = read_printed_displacements(printed, printed_name, nodes);
    const auto exact = find_in_restart(restart, result.displacements);
    if (exact) result = {*exact, true};
    return result;
}

using namespace reference_fem;

SecondOpinion second_opinion(const std::string& program, const AnsweredProblem& ours, const DeckOptions& options,
                             const CalculixLimits& limits)
{
    const CalculixRun run = run_calculix(
        program, [&](std::ostream& deck) { write_calculix_deck(deck, ours.problem, options); }, limits);
    SecondOpinion opinion;
    opinion.outcome = run.outcome;
    opinion.wall_s = run.wall_s;
    opinion.largest_displacement_m = ours.displacements.rowwise().norm().maxCoeff();
    if (run.outcome != CalculixOutcome::finished) {
        opinion.last_words = last_words(run.output);
        return opinion;
    }
    const CalculixDisplacements theirs = read_displacements(run.printed, run.restart, ours.displacements.rows());
    opinion.in_double = theirs.in_double;
    opinion.largest_difference_m = (theirs.displacements - ours.displacements).rowwise().norm().maxCoeff(&opinion.node);
    return opinion;
}

}  // namespace reference_fem
