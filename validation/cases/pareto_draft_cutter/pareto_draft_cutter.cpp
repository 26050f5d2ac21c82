/// \file Speed against error of the draft model cutter's outflow, the flow alone.
#include "validation/harness/scenes/cutter_trials.hpp"

namespace {

using namespace cutterflow::validation;

CutterOptions courant(double largest) {
    CutterOptions options;
    options.max_courant = largest;
    return options;
}

CutterOptions upwind() {
    CutterOptions options;
    options.convection = cutterflow::cases::ConvectionScheme::upwind;
    return options;
}

void run(Verification& verification) {
    if (!verification.wants(Effort::longest)) return;
    verification.table(
        {"Options without a chart",
         {"option", "why"},
         {{"mesh", "Draft against standard is a comparison of whole batches, docs/results/draft_and_standard_mesh, at 7.2 times the cost."},
          {"coupling interval", "The solver has no such option: fluid and rock exchange momentum in every fluid step."}}});
    run_cutter_sweeps(
        verification, {},
        {{"time step, largest Courant number", {{"3.6", courant(3.6)}, {"1.8", {}, true}, {"0.9", courant(0.9)}, {"0.45", courant(0.45)}}},
         {"convection scheme, against the default of second order", {{"upwind", upwind()}, {"linearUpwindV grad(U)", {}, true}}}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
