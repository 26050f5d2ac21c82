#pragma once
/// \file Jobs of a sweep by the scheduler Slurm: one task of a job array each.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace cutterflow::cases {

struct SlurmTask {
    std::vector<std::string> arguments;  ///< program and its arguments
    std::filesystem::path log;           ///< receives its output
};

/// The script that sbatch takes: a job array with one element per task, on `ranks` cores of one node each. Partition, account and time
/// limit are the user's: sbatch takes them from SBATCH_PARTITION, SBATCH_ACCOUNT, SBATCH_TIMELIMIT ...
std::string slurm_script(const std::string& job_name, const std::vector<SlurmTask>& tasks, int ranks);

/// Hands a script to sbatch. \return the job's number \throws ToolError when sbatch refuses
std::string submit_to_slurm(const std::filesystem::path& script);

/// Waits until no element of the job is queued or running. A scheduler that does not answer is queried again. `looked` is called after each
/// query. \throws Interrupted  when the user stops the waiting; the job continues
void wait_for_slurm(const std::string& job, const std::function<void()>& looked);

}  // namespace cutterflow::cases
