#include "validation/corpus/judge.hpp"

#include <cmath>
#include <csignal>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/io/read_surface.hpp"
#include "geometry/surface/soundness.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

// As timeout(1) and the signals of prlimit(1) end a program.
constexpr int k_timed_out = 124;
constexpr int k_processor_time_over = 128 + SIGXCPU;
constexpr int k_killed = 128 + SIGKILL;
/// Wall time for a program that waits instead of working, on a machine with other work.
constexpr int k_wall_limit_s = 3600;

/// What is wrong with a repaired surface; empty when nothing is.
std::string complaint_about(const fs::path& output, const DamagedFile& file, Verdict& verdict) {
    if (!file.refusal.empty()) return "repaired, but should have been refused: " + file.refusal;
    const geometry::SoundnessReport report = geometry::inspect_surface(geometry::read_surface(output));
    if (!report.sound()) return "the result is not sound: " + geometry::defects_of(report, "").front().text();
    verdict.volume_error = std::abs(report.volume / file.sound_volume - 1.0);
    if (verdict.volume_error <= k_largest_volume_error) return "";
    return fmt::format("volume {:.6g} m3 instead of {:.6g} m3", report.volume, file.sound_volume);
}

std::string complaint_about_refusal(const std::string& text, const fs::path& output, const DamagedFile& file) {
    if (file.sound_volume > 0.0) return "refused, but can be repaired: " + text;
    if (text.find(file.refusal) == std::string::npos) return fmt::format("the refusal lacks \"{}\": {}", file.refusal, text);
    if (fs::exists(output)) return "refused, but wrote a surface";
    return "";
}

/// The program's message, which follows its report.
std::string message_of(const std::string& text) {
    const std::size_t at = text.find("cutterflow: ");
    return at == std::string::npos ? text : text.substr(at, text.find('\n', at) - at);
}

}  // namespace

Verdict judge(const DamagedFile& file, const fs::path& cutterflow, const fs::path& folder) {
    Verdict verdict;
    verdict.name = file.name;
    const fs::path input = folder / file.name;
    const fs::path output = folder / (file.name + ".repaired.stl");
    const fs::path log = folder / (file.name + ".log");
    fs::remove(output);
    write_file(input, file.content());
    const std::string before = sha256_of_file(input);

    std::vector<std::string> command{"timeout",           std::to_string(k_wall_limit_s),
                                     "prlimit",           fmt::format("--cpu={}", k_core_limit_s),
                                     cutterflow.string(), "repair",
                                     input.string(),      "-o",
                                     output.string()};
    command.insert(command.end(), file.options.begin(), file.options.end());
    const ChildResult result = run_child({command, folder, log, {}});
    const std::string text = read_file(log);
    verdict.core_s = result.core_s;
    verdict.repaired = result.exit_code == 0;
    verdict.refused = result.exit_code == 2;
    verdict.hung = result.exit_code == k_timed_out || result.exit_code == k_processor_time_over || result.exit_code == k_killed;
    verdict.crashed = !verdict.repaired && !verdict.refused && !verdict.hung;

    std::string complaint;
    if (verdict.repaired) complaint = complaint_about(output, file, verdict);
    if (verdict.refused) complaint = complaint_about_refusal(text, output, file);
    if (verdict.hung) complaint = fmt::format("no end within {} s of processor time", k_core_limit_s);
    if (verdict.crashed) complaint = fmt::format("exit code {}: {}", result.exit_code, message_of(text));
    if (sha256_of_file(input) != before) complaint = "the input was changed";
    verdict.passed = complaint.empty();
    verdict.note = verdict.passed && verdict.refused ? message_of(text) : complaint;
    return verdict;
}

}  // namespace cutterflow::validation
