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

/// A job array as `sbatch --parsable` names it.
struct SlurmJob {
    std::string number;
    std::string cluster;  ///< of several; empty: the scheduler's own

    std::string text() const;    ///< "123" or "123;cluster"
    std::string cancel() const;  ///< the command that ends it
};

/// \param text  as SlurmJob::text
SlurmJob slurm_job(const std::string& text);

/// The script that sbatch takes: a job array with one element per task, on `ranks` cores of one node each. Partition, account and time
/// limit are the user's: sbatch takes them from SBATCH_PARTITION, SBATCH_ACCOUNT, SBATCH_TIMELIMIT ...
/// \param job_file  receives the job's number when its elements begin; empty: none does
std::string slurm_script(const std::string& job_name, const std::vector<SlurmTask>& tasks, int ranks,
                         const std::filesystem::path& job_file = {});

/// Hands a script to sbatch. \throws ToolError when sbatch refuses
SlurmJob submit_to_slurm(const std::filesystem::path& script);

/// Waits until no element of the job is queued or running. A scheduler that does not answer is queried again. `looked` is called after each
/// query. \throws Interrupted  when the user stops the waiting; the job continues
void wait_for_slurm(const SlurmJob& job, const std::function<void()>& looked);

}  // namespace cutterflow::cases
