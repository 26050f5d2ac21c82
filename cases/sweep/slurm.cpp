#include "cases/sweep/slurm.hpp"

#include <algorithm>
#include <cctype>

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

}  // namespace

std::string slurm_script(const std::string& job_name, const std::vector<SlurmTask>& tasks, int ranks) {
    std::string script = fmt::format(
        "#!/bin/sh\n#SBATCH --job-name={}\n#SBATCH --array=0-{}\n#SBATCH --nodes=1\n#SBATCH --ntasks={}\n#SBATCH --output=/dev/null\n"
        "#SBATCH --no-requeue\ncase \"$SLURM_ARRAY_TASK_ID\" in\n",
        job_name, tasks.size() - 1, ranks);
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        std::string line = fmt::format("{}) exec", i);
        for (const std::string& argument : tasks[i].arguments) line += " " + shell_word(argument);
        script += fmt::format("{} > {} 2>&1 ;;\n", line, shell_word(tasks[i].log.string()));
    }
    return script + "esac\n";
}

std::string submit_to_slurm(const fs::path& script) {
    const Answer answer = ask({"sbatch", "--parsable", script.string()});
    // "123" or "123;cluster".
    const std::string job = answer.text.substr(0, answer.text.find_first_of(";\n"));
    const bool number = !job.empty() && std::all_of(job.begin(), job.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    if (answer.exit_code == 0 && number) return job;
    throw ToolError(
        {"", fmt::format("sbatch refused {}: {}", script.string(), answer.text), "The scheduler must accept the job",
         "Set the variables that your cluster requires (SBATCH_PARTITION, SBATCH_ACCOUNT, SBATCH_TIMELIMIT ...) and use --resume"});
}

void wait_for_slurm(const std::string& job, const std::function<void()>& looked) {
    while (true) {
        const Answer answer = ask({"squeue", "--noheader", "--format=%i", "--jobs=" + job});
        const bool forgotten = answer.text.find("Invalid job id") != std::string::npos;
        looked();
        if (forgotten || (answer.exit_code == 0 && answer.text.empty())) return;
        ask({"sleep", "2"});  // as a child, so that an interrupt ends it
    }
}

}  // namespace cutterflow::cases
