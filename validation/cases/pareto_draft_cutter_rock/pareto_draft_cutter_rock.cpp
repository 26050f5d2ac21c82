/// \file Speed against error of the draft model cutter's outflow with rock in the head.
#include "validation/harness/scenes/cutter_trials.hpp"

namespace {

using namespace cutterflow::validation;

/// The defaults with one option at a value.
CutterOptions with(std::optional<double> CutterOptions::*option, double value) {
    CutterOptions options;
    options.rock = true;
    options.*option = value;
    return options;
}

void run(Verification& verification) {
    if (!verification.wants(Effort::longest)) return;
    CutterOptions standard;
    standard.rock = true;
    const auto gamma = [](double value) { return with(&CutterOptions::gamma, value); };
    const auto step = [](double value) { return with(&CutterOptions::dem_step, value); };
    const auto modulus = [](double value) { return with(&CutterOptions::youngs_modulus, value); };
    run_cutter_sweeps(verification, standard,
                      {{"kernel width gamma, against the widest", {{"0.5", gamma(0.5)}, {"1", standard, true}, {"2", gamma(2.0)}}},
                       {"DEM step over the shortest contact time", {{"0.3", step(0.3)}, {"0.1", standard, true}, {"0.05", step(0.05)}}},
                       {"Young's modulus, Pa", {{"2.6e7", modulus(2.6e7)}, {"2.6e8", standard, true}, {"1e9", modulus(1e9)}}}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
