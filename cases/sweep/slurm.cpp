#include "cases/sweep/slurm.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/process/shell_word.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

struct Answer {
    int exit_code = 0;
    std::string text;
};

Answer ask(const std::vector<std::string>& arguments) {
    Answer answer;
    answer.exit_code = run_child({arguments, {}, {}, {}}, [&](const std::string& line) { answer.text += line + "\n"; }).exit_code;
    return answer;
}

/// Whether an answer of squeue has an element; with --clusters it names the cluster in a line of its own.
bool has_elements(const std::string& answer) {
    std::istringstream lines(answer);
    for (std::string line; std::getline(lines, line);)
        if (!line.empty() && line.rfind("CLUSTER:", 0) != 0) return true;
    return false;
}

}  // namespace

std::string slurm_script(const std::string& job_name, const std::vector<SlurmTask>& tasks, int ranks, const fs::path& job_file) {
    std::string script = fmt::format(
        "#!/bin/sh\n#SBATCH --job-name={}\n#SBATCH --array=0-{}\n#SBATCH --nodes=1\n#SBATCH --ntasks={}\n#SBATCH --output=/dev/null\n"
        "#SBATCH --no-requeue\n",
        job_name, tasks.size() - 1, ranks);
    if (!job_file.empty())
        script += fmt::format("[ -z \"$SLURM_ARRAY_JOB_ID\" ] || printf %s \"$SLURM_ARRAY_JOB_ID\" > {}\n", shell_word(job_file.string()));
    script += "case \"$SLURM_ARRAY_TASK_ID\" in\n";
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        std::string line = fmt::format("{}) exec", i);
        for (const std::string& argument : tasks[i].arguments) line += " " + shell_word(argument);
        script += fmt::format("{} > {} 2>&1 ;;\n", line, shell_word(tasks[i].log.string()));
    }
    return script + "esac\n";
}

SlurmJob slurm_job(const std::string& text) {
    const std::string line = text.substr(0, text.find('\n'));
    const std::size_t semicolon = line.find(';');
    return {line.substr(0, semicolon), semicolon == std::string::npos ? "" : line.substr(semicolon + 1)};
}

std::string SlurmJob::text() const {
    return cluster.empty() ? number : number + ";" + cluster;
}

std::string SlurmJob::cancel() const {
    return "scancel " + (cluster.empty() ? "" : "--clusters=" + cluster + " ") + number;
}

SlurmJob submit_to_slurm(const fs::path& script) {
    const Answer answer = ask({"sbatch", "--parsable", script.string()});
    const SlurmJob job = slurm_job(answer.text);
    const bool number =
        !job.number.empty() && std::all_of(job.number.begin(), job.number.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    if (answer.exit_code == 0 && number) return job;
    throw ToolError(
        {"", fmt::format("sbatch refused {}: {}", script.string(), answer.text), "The scheduler must accept the job",
         "Set the variables that your cluster requires (SBATCH_PARTITION, SBATCH_ACCOUNT, SBATCH_TIMELIMIT ...) and use --resume"});
}

void wait_for_slurm(const SlurmJob& job, const std::function<void()>& looked) {
    std::vector<std::string> query{"squeue", "--noheader", "--format=%i", "--jobs=" + job.number};
    if (!job.cluster.empty()) query.push_back("--clusters=" + job.cluster);
    while (true) {
        const Answer answer = ask(query);
        const bool forgotten = answer.text.find("Invalid job id") != std::string::npos;
        looked();
        if (forgotten || (answer.exit_code == 0 && !has_elements(answer.text))) return;
        ask({"sleep", "2"});  // as a child, so that an interrupt ends it
    }
}

}  // namespace cutterflow::cases
