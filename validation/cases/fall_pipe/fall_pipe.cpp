/// Level, reversal and order of emptying of fall pipes, through the program.
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "postproc/analysis/surface_results.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/program_run.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

struct Dumping {
    postproc::SurfaceResults results;
    double upward_s = 0.0;       // water flows up into the mouth
    double rising_s = 0.0;       // bodies rise in the mean meanwhile
    double balance_error = 0.0;  // of the water in the pipe, over its largest change
};

/// Volumes that flowed through mouth and holes beside the change of the particles' volume in the pipe.
void follow_flows(const postproc::Table& levels, Dumping& dumping) {
    const auto& time = levels.number("time_s");
    const auto& volume = levels.number("volume_in_pipe_m3");
    double flown = 0.0, largest = 0.0, apart = 0.0;
    for (std::size_t n = 1; n < levels.rows(); ++n) {
        const double step = time[n] - time[n - 1], mouth = levels.number("mouth_flow_m3_s")[n];
        flown += step * (mouth + levels.number("hole_flow_m3_s")[n]);
        const double change = volume[n] - volume[0];
        largest = larger(largest, std::abs(change));
        apart = larger(apart, std::abs(change - flown));
        if (mouth <= 0.0) continue;
        dumping.upward_s += step;
        if (levels.number("rise_in_pipe_m_s")[n] > 0.0 && levels.number("bodies_in_pipe")[n] > 0.0) dumping.rising_s += step;
    }
    dumping.balance_error = largest > 0.0 ? apart / largest : 1.0;
}

Dumping dump(Verification& verification, const std::string& pipe, int seed) {
    const auto folder = verification.folder(fmt::format("{}_{}", pipe, seed));
    std::string study = read_file(installation().data / "cases/examples/fall_pipe" / (pipe + ".toml"));
    const std::string first = "seed = 1";
    study.replace(study.find(first), first.size(), fmt::format("seed = {}", seed));
    std::filesystem::create_directories(folder);
    write_file(folder / "study.toml", study);
    run_study(folder);
    const postproc::SurfaceRows rows = postproc::read_surface_rows(folder / "run");
    Dumping dumping{postproc::surface_results(rows)};
    follow_flows(rows.levels, dumping);
    const std::string name = fmt::format(", {}, jitter {}", pipe, seed);
    verification.report("all bodies out" + name, "s", dumping.results.all_out_s, {}, {"Chen2019", "", {}});
    verification.report("half of the bodies out" + name, "s", dumping.results.half_out_s, {}, {"Chen2019", "tells nothing", {}});
    verification.at_most("occupied volume lost or won" + name, "-", std::abs(dumping.results.volume_error), 0.01, {"exact", "", {}});
    verification.at_most("change of the water in the pipe less what flowed, over the largest change" + name, "-", dumping.balance_error,
                         0.02, {"exact", "mouth and holes", {}});
    verification.at_most("particles through the pipe's wall" + name, "-", dumping.results.through_walls, 0.0,
                         {"exact", "any that pass its middle elsewhere than in holes, all steps", {}});
    verification.at_most("core seconds" + name, "s", dumping.results.core_s, 600.0, {"exact", "until empty, on one core", {}});
    return dumping;
}

void check_pair(Verification& verification, const Dumping& continuous, const Dumping& perforated, int seed) {
    const std::string name = fmt::format(", jitter {}", seed);
    verification.at_least("drop of the level in the continuous pipe" + name, "m", continuous.results.greatest_drop_m, 0.03,
                          {"exact", "a choice: the story is that of Chen2019, whose numbers are lost", {}});
    verification.at_least("time of upward flow in the mouth, continuous" + name, "s", continuous.upward_s, 0.1,
                          {"exact", "a choice, as the drop", {}});
    verification.at_least("time in which bodies rise meanwhile, continuous" + name, "s", continuous.rising_s, 0.1,
                          {"exact", "a choice, as the drop", {}});
    verification.at_most("drop in the perforated pipe over that in the continuous one" + name, "-",
                         perforated.results.greatest_drop_m / continuous.results.greatest_drop_m, 1.0,
                         {"Chen2019", "less in the perforated pipe", {}});
}

void run(Verification& verification) {
    const int pairs = verification.wants(Effort::longest) ? 5 : 1;
    std::vector<double> earlier;
    for (int seed = 1; seed <= pairs; ++seed) {
        const Dumping continuous = dump(verification, "continuous", seed), perforated = dump(verification, "perforated", seed);
        check_pair(verification, continuous, perforated, seed);
        earlier.push_back(continuous.results.all_out_s - perforated.results.all_out_s);
    }
    if (pairs == 1) {
        verification.report("continuous empties later than perforated by", "s", earlier[0], {}, {"Chen2019", "one pair: chance", {}});
        return;
    }
    double mean = 0.0, square = 0.0;
    for (const double one : earlier) mean += one / pairs;
    for (const double one : earlier) square += (one - mean) * (one - mean);
    const double half = 2.776 * std::sqrt(square / (pairs - 1) / pairs);  // Student, four degrees of freedom
    verification.at_least("lower end of the interval of the time by which continuous empties later", "s", mean - half, 0.0,
                          {"Chen2019", fmt::format("five pairs, 95 %, mean {:.3g} s", mean), {}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
